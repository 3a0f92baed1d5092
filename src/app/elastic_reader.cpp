// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/elastic_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/body_keys.hpp"
#include "app/mesh_reader.hpp"

namespace drogue::app {

namespace {

const Range ratio{.min = -1.0, .max = 0.5, .open = true};

double read_young(Section& material) {
  return material.get<double>("young", {.unit = "Pa", .doc = "Young's modulus", .range = positive});
}

double read_poisson(Section& material, const Range& range) {
  return material.get<double>("poisson", {.doc = "Poisson's ratio", .range = range});
}

fem::NeoHookean read_neo_hookean(Section& material) {
  const double young = read_young(material), poisson = read_poisson(material, ratio);
  const double stabilisation = material.get<double>(
      "poisson_stabilisation",
      {.doc = "ratio behind the bulk modulus, for law = \"neo_hookean\"; by default that of poisson",
       .derived = poisson,
       .range = ratio});
  if (material.describing()) return {1.0, 0.0, 0.0};
  return {young, poisson, stabilisation};
}

fem::SaintVenantKirchhoff read_saint_venant_kirchhoff(Section& material) {
  const double young = read_young(material), poisson = read_poisson(material, ratio);
  if (material.describing()) return {1.0, 0.0};
  return {young, poisson};
}

fem::OrthotropicFabric read_fabric(Section& material) {
  const double warp = material.get<double>("young_warp", {.unit = "Pa", .doc = "of a fabric", .range = positive});
  const double weft = material.get<double>("young_weft", {.unit = "Pa", .doc = "of a fabric", .range = positive});
  const double poisson = material.get<double>(
      "poisson_warp", {.doc = "contraction of the weft by stress in the warp, of a fabric", .fallback = 0.0});
  const double shear = material.get<double>("shear", {.unit = "Pa", .doc = "modulus of a fabric", .range = positive});
  if (material.describing()) return {1.0, 1.0, 0.0, 1.0};
  return {warp, weft, poisson, shear};
}

fem::LinearCable read_cable_law(Section& section) {
  const double young = read_young(section);
  const bool tension_only =
      section.get<bool>("tension_only", {.doc = "whether a cable goes slack rather than push", .fallback = true});
  return {young, tension_only};
}

enum class Law { neo_hookean, saint_venant_kirchhoff, fabric, cable };

Law read_law(Section& material) {
  return material.choose<Law>("law",
                              {{"neo_hookean", Law::neo_hookean},
                               {"saint_venant_kirchhoff", Law::saint_venant_kirchhoff},
                               {"fabric", Law::fabric},
                               {"cable", Law::cable}},
                              {.doc = "of solids and membranes: neo_hookean, saint_venant_kirchhoff; of membranes: "
                                      "fabric; of lines: cable"});
}

fem::MembraneMaterial read_membrane_material(Section& material, Law law, bool wrinkling) {
  const auto that_folds_or_not = [&]<class Plane>(const Plane& plane) -> fem::MembraneMaterial {
    if (wrinkling) return fem::TensionField<Plane>{plane};
    return plane;
  };
  if (law == Law::fabric) return that_folds_or_not(read_fabric(material));
  if (law == Law::neo_hookean) return that_folds_or_not(fem::PlaneNeoHookean{read_neo_hookean(material)});
  return that_folds_or_not(fem::PlaneSaintVenantKirchhoff{read_saint_venant_kirchhoff(material)});
}

fem::Membrane read_membrane(Section& section, Section& material, Law law) {
  fem::Membrane membrane{.material = fem::OrthotropicFabric(1.0, 1.0, 0.0, 1.0)};
  membrane.thickness = section.get<double>(
      "thickness", {.unit = "m", .doc = "which makes of quadrangles and triangles a membrane", .range = positive});
  membrane.warp = section.get<Vec3>(
      "warp", {.doc = "direction of a fabric's warp, projected on each element", .fallback = Vec3(1.0, 0.0, 0.0)});
  if (membrane.warp.norm() == 0.0) section.fail("warp", "= [0, 0, 0] is no direction");
  const bool wrinkling = section.get<bool>(
      "wrinkling", {.doc = "whether a membrane folds rather than bear compression (tension field)", .fallback = false});
  membrane.material = read_membrane_material(material, law, wrinkling);
  return membrane;
}

double read_section(Section& section) {
  return section.get<double>("section", {.unit = "m^2", .doc = "of a cable", .range = positive});
}

double read_density(Section& section, bool coupled) {
  return section.get<double>("density", {.unit = "kg/m^3",
                                         .doc = "own mass; 0 only of what is coupled with the fluid",
                                         .range = coupled ? not_negative : positive});
}

fem::ActiveStress read_active(Section section) {
  fem::ActiveStress active;
  active.tension = section.get<Expression>(
      "tension", {.unit = "Pa", .doc = "formula of t: T of P = J T F f0 f0^T", .fallback = Expression(0.0)});
  expect_time_alone(section, "tension", active.tension);
  const Vec3 direction = section.get<Vec3>(
      "direction", {.doc = "f0 in a solid; a membrane's is its warp, a cable's the cable", .fallback = Vec3(1, 0, 0)});
  if (direction.norm() == 0.0) section.fail("direction", "= [0, 0, 0] is no direction");
  active.direction = direction.normalized();
  return active;
}

/// Whether a part of the body meets the fluid, if there is one.
bool read_coupled(Section& section, bool in_flow) {
  return in_flow && section.get<bool>("coupled", {.doc = "whether this part meets the fluid; one that does not may "
                                                         "leave the finest cells and is not dragged",
                                                  .fallback = true});
}

constexpr const char* active_doc = "active stress, of elements that pull by themselves";

fem::Hexahedron read_element(Section& section) {
  return section.choose<fem::Hexahedron>(
      "element", {{"assumed_strain", fem::Hexahedron::assumed_strain}, {"trilinear", fem::Hexahedron::trilinear}},
      {.doc = "of a solid: assumed_strain, or trilinear, which locks in bending", .fallback = "assumed_strain"});
}

/// A membrane has a thickness, a cable the law of one; the rest is solid.
fem::Region read_region(Section& section, bool coupled) {
  fem::Region region;
  region.coupled = coupled;
  region.density = read_density(section, coupled);
  Section material = section.section("material", "what the region is made of");
  if (section.describing()) {
    region.kind = read_membrane(section, material, Law::neo_hookean);
    read_fabric(material);
    read_section(section);
    read_element(section);
  }
  const Law law = read_law(material);
  if (law == Law::cable || section.describing()) {
    const fem::LinearCable cable = read_cable_law(material);
    region.kind = fem::Cable{cable, read_section(section)};
  } else if (law == Law::fabric || section.has("thickness")) {
    region.kind = read_membrane(section, material, law);
  } else if (law == Law::neo_hookean) {
    region.kind = fem::Solid{read_neo_hookean(material), read_element(section)};
  } else {
    region.kind = fem::Solid{read_saint_venant_kirchhoff(material), read_element(section)};
  }
  region.active = read_active(section.section("active", active_doc));
  return region;
}

void read_regions(Section& section, bool in_flow, ElasticBody& body) {
  section.each("region", "of the mesh, if not all of it is alike: density, material and so on stand here then",
               [&](Section& part) {
                 const std::string name = part.get<std::string>("name", {.doc = "of a physical group of the mesh"});
                 body.regions.push_back(read_region(part, read_coupled(part, in_flow)));
                 body.regions.back().elements = name;
               });
  const bool cables_alone = std::holds_alternative<fem::Mesh>(body.mesh);
  if ((body.regions.empty() && !cables_alone) || section.describing())
    body.regions.push_back(read_region(section, in_flow));
}

PointDescription read_point(Section& section) {
  PointDescription point;
  point.name = section.get<std::string>("name", {.doc = "as a node set, for cables and holds"});
  point.place = section.get<Vec3>("place", {.unit = "m", .doc = "of a node that is added to the mesh"});
  point.mass = section.get<double>("mass", {.unit = "kg", .doc = "on its own", .fallback = 0.0, .range = not_negative});
  return point;
}

CableDescription read_cable(Section& section, bool in_flow) {
  CableDescription cable;
  cable.name = section.get<std::string>("name", {.doc = "as a node set"});
  cable.from = section.get<std::string>("from", {.doc = "a node set: a cable begins at each of its nodes"});
  cable.to = section.get<std::string>("to", {.doc = "a node set: it ends at the nearest of its nodes"});
  cable.elements = section.get<int>("elements", {.doc = "of each cable", .range = {.min = 1, .max = 100000}});
  cable.length = section.get<double>(
      "length",
      {.unit = "m", .doc = "unstressed; 0 for the distance in the mesh", .fallback = 0.0, .range = not_negative});
  cable.region.elements = cable.name;
  cable.region.coupled = read_coupled(section, in_flow);
  cable.region.density = read_density(section, cable.region.coupled);
  const double area = read_section(section);
  cable.region.kind = fem::Cable{read_cable_law(section), area};
  cable.region.active = read_active(section.section("active", active_doc));
  return cable;
}

NodesNamed read_nodes(Section& section) {
  NodesNamed nodes;
  nodes.name = section.get<std::string>(
      "nodes", {.doc = "\"all\", \"corners\", \"rim\" (of a surface), \"x_min\" to \"z_max\" (furthest that way), or a "
                       "node set of the mesh, a point or a cable"});
  if (section.describing() || nodes.name == "corners") {
    nodes.patch = section.get<double>("patch", {.unit = "m",
                                                .doc = "edge of the held corner, for nodes = \"corners\"; 0 holds the "
                                                       "corner nodes alone",
                                                .fallback = 0.0,
                                                .range = not_negative});
  }
  return nodes;
}

std::array<bool, 3> read_axes(Section& section) {
  const std::string letters =
      section.get<std::string>("axes", {.doc = "along which the nodes are held", .fallback = "xyz"});
  const bool known = !letters.empty() && letters.find_first_not_of("xyz") == std::string::npos;
  if (!known) section.fail("axes", fmt::format("= \"{}\"; expected some of the letters x, y, z", letters));
  std::array<bool, 3> held{};
  for (int axis = 0; axis < 3; ++axis) held[axis] = letters.find("xyz"[axis]) != std::string::npos;
  return held;
}

HoldDescription read_hold(Section& section, bool in_flow) {
  HoldDescription description{read_nodes(section), {}};
  fem::Hold& hold = description.hold;
  hold.axes = read_axes(section);
  hold.rigid = section.get<bool>("rigid", {.doc = "hold in place instead of by a tether", .fallback = false});
  if (section.describing() || !hold.rigid) {
    hold.stiffness = section.get<double>(
        "stiffness", {.unit = "N/m^4", .doc = "of the tether, per displacement and volume", .range = positive});
    hold.damping = section.get<double>(
        "damping",
        {.unit = "N s/m^4", .doc = "of the tether, per velocity and volume", .fallback = 0.0, .range = not_negative});
  }
  if (in_flow) {
    hold.hinged = section.get<bool>(
        "hinged", {.doc = "of a solid thinner than a cell: hold its mid-surface, which may turn", .fallback = false});
  }
  hold.displacement = read_formulas_of_time(
      section, "displacement", {.unit = "m", .doc = "prescribed, of the place that is held", .fallback = Formulas{}});
  return description;
}

Probe read_probe(Section& section) {
  Probe probe;
  probe.name = section.get<std::string>("name", {.doc = "of the column and the result"});
  probe.place = section.get<Vec3>("place", {.unit = "m", .doc = "the node of the mesh that is nearest to it"});
  const Vec3 direction = section.get<Vec3>("direction", {.doc = "of the displacement that is measured"});
  if (direction.norm() == 0.0 && !section.describing()) section.fail("direction", "= [0, 0, 0] is no direction");
  probe.direction = direction.normalized();
  probe.scale = section.get<double>(
      "over", {.unit = "m", .doc = "a length that the displacement is divided by", .fallback = 1.0, .range = positive});
  probe.statistic = section.choose<std::string>(
      "result",
      {{"last", "last"},
       {"peak", "peak"},
       {"stable", "stable"},
       {"period", "period"},
       {"peak_to_peak", "peak_to_peak"},
       {"strouhal", "strouhal"}},
      {.doc = "last value, peak, mean over results.stable_window, period of oscillation; over that window "
              "highest less lowest value, or frequency times fluid.reference_length / reference_velocity",
       .fallback = "last"});
  return probe;
}

void read_loads(Section& section, ElasticBody& body, bool in_flow) {
  section.each("hold", "nodes that are held near where they start",
               [&](Section& hold) { body.holds.push_back(read_hold(hold, in_flow)); });
  section.each("force", "a dead load on nodes", [&](Section& force) {
    body.forces.push_back({read_nodes(force), {}});
    body.forces.back().force = read_formulas_of_time(
        force, "force", {.unit = "N", .doc = "in all, shared by the volume around the nodes; formulas of t"});
  });
  section.each("pressure", "which follows the surface it acts on", [&](Section& pressure) {
    fem::Pressure& load = body.pressures.emplace_back();
    load.elements = pressure.get<std::string>(
        "region", {.doc = "quadrangles and triangles of a physical group; by default all", .fallback = ""});
    load.pressure = pressure.get<Expression>(
        "pressure", {.unit = "Pa",
                     .doc = "formula of t; pushes towards the side from which the nodes of an element appear in "
                            "counter-clockwise order"});
    expect_time_alone(pressure, "pressure", load.pressure);
  });
  body.gravity = section.get<Vec3>(
      "gravity", {.unit = "m/s^2",
                  .doc = "on what the body's mass exceeds the fluid's by; without a fluid, on all of it",
                  .fallback = Vec3(0.0, 0.0, 0.0)});
  body.damping = section.get<double>(
      "damping", {.unit = "1/s", .doc = "Rayleigh's, of the own mass", .fallback = 0.0, .range = not_negative});
  body.stiffness_damping =
      section.get<double>("stiffness_damping", {.unit = "s",
                                                .doc = "Rayleigh's, of the stiffness; shortens the sub-step",
                                                .fallback = 0.0,
                                                .range = not_negative});
}

fem::StructureOptions read_structure(Section& body, bool in_flow) {
  const Choices<fem::Integrator> integrators{{"explicit", fem::Integrator::explicit_scheme},
                                             {"implicit", fem::Integrator::implicit_scheme},
                                             {"auto", fem::Integrator::cheaper}};
  fem::StructureOptions options;
  options.integrator =
      body.choose("integrator", integrators,
                  {.doc = "of its motion: explicit with automatic sub-steps, implicit (generalised-alpha) "
                          "with one step of the fluid or of structure.step, or what is cheaper by estimate",
                   .fallback = "explicit"});
  if (body.describing() || options.integrator != fem::Integrator::explicit_scheme) {
    options.spectral_radius =
        body.get<double>("spectral_radius", {.doc = "of the implicit scheme, for what a step does not resolve: 0 damps "
                                                    "it at once, 1 never",
                                             .fallback = options.spectral_radius,
                                             .range = {.min = 0.0, .max = 1.0}});
  }
  options.dissipation = body.get<double>(
      "dissipation", {.doc = "numerical, of what the sub-step barely resolves; may be 0 without a fluid",
                      .fallback = options.dissipation,
                      .range = {.min = 0.0, .max = 0.49, .open = in_flow}});
  options.safety = body.get<double>("safety", {.doc = "share of the stable sub-step that is used",
                                               .fallback = options.safety,
                                               .range = {.min = 0.01, .max = 1.0}});
  options.volume_ratio = body.get<Pair>(
      "volume_ratio",
      {.doc = "bounds of J; an element beyond them ends the run", .fallback = options.volume_ratio, .range = positive});
  return options;
}

fsi::CouplingOptions read_coupling(Section coupling, const Case& c, const std::string& body) {
  const Choices<fsi::Scheme> schemes{{"added_mass", fsi::Scheme::added_mass}, {"peskin", fsi::Scheme::peskin}};
  fsi::CouplingOptions options;
  options.scheme = coupling.choose("scheme", schemes, {.doc = "how body and fluid meet", .fallback = "added_mass"});
  options.delta = read_delta(coupling);
  options.fluid_density = c.fluid.density;
  options.body = body;
  return options;
}

}  // namespace

Body read_elastic(Section& section, const Case& c) {
  const bool in_flow = c.has_fluid() || section.describing();
  ElasticBody body;
  const std::string name = read_name(section);
  body.mesh = read_mesh_description(section);
  read_regions(section, in_flow, body);
  section.each("point", "a node that is added to the mesh, with or without a mass",
               [&](Section& point) { body.points.push_back(read_point(point)); });
  section.each("cable", "cables that are added to the mesh",
               [&](Section& cable) { body.cables.push_back(read_cable(cable, in_flow)); });
  read_loads(section, body, in_flow);
  body.structure = read_structure(section, in_flow);
  section.each("probe", "a displacement to be measured",
               [&](Section& probe) { body.probes.push_back(read_probe(probe)); });
  const double reference_area = in_flow ? read_reference_area(section, area_of(body.mesh)) : 0.0;
  if (in_flow) body.coupling = read_coupling(section.section("coupling", coupling_doc), c, name);
  if (body.coupling.scheme == fsi::Scheme::peskin && body.structure.integrator != fem::Integrator::explicit_scheme) {
    section.fail("integrator", "has no meaning with coupling.scheme = \"peskin\", which moves nodes with the fluid");
  }
  return {name, reference_area, std::move(body), in_flow};
}

}  // namespace drogue::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.hpp"
#include "fem/plane_stress.hpp"
#include "fem/structure_data.hpp"

namespace drogue::fem {
namespace {

StructureOptions checked(const StructureOptions& options) {
  const auto& [dissipation, safety, ratio, integrator, spectral_radius] = options;
  // From 0.5 on a stiff tether would be unstable.
  if (!(dissipation >= 0.0 && dissipation < 0.5)) {
    throw InputError(
        fmt::format("the structure's dissipation is {}; expected at least 0 and less than 0.5", dissipation));
  }
  if (!(safety > 0.0 && safety <= 1.0)) {
    throw InputError(
        fmt::format("the safety of the structure's stable step is {}; expected more than 0, at most 1", safety));
  }
  if (!(ratio[0] > 0.0 && ratio[0] < 1.0 && ratio[1] > 1.0)) {
    throw InputError(fmt::format("the bounds of the volume ratio are {} and {}; expected 0 < lower < 1 < upper",
                                 ratio[0], ratio[1]));
  }
  if (!(spectral_radius >= 0.0 && spectral_radius <= 1.0)) {
    throw InputError(
        fmt::format("the spectral radius of the structure's implicit scheme is {}; expected 0 to 1", spectral_radius));
  }
  return options;
}

void expect_node(const char* what, int node, std::size_t nodes) {
  if (node >= 0 && static_cast<std::size_t>(node) < nodes) return;
  throw InputError(fmt::format("{} names node {}; expected 0 to {}", what, node, nodes - 1));
}

std::vector<Holds> hold_of_each_node(const std::vector<Hold>& holds, std::size_t nodes) {
  std::vector<Holds> of_node(nodes, {nullptr, nullptr, nullptr});
  for (const Hold& hold : holds) {
    if (!(hold.stiffness >= 0.0 && hold.damping >= 0.0)) {
      throw InputError(
          fmt::format("a hold has stiffness {} N/m^4 and damping {} N s/m^4; expected neither to be negative",
                      hold.stiffness, hold.damping));
    }
    for (const int node : hold.nodes) {
      expect_node("a hold", node, nodes);
      for (int axis = 0; axis < 3; ++axis) {
        if (!hold.axes[axis]) continue;
        const Hold*& held_by = of_node[node][axis];
        const bool alike = held_by && held_by->stands_still() && hold.stands_still();
        if (held_by != nullptr && held_by != &hold && !alike) {
          throw InputError(
              fmt::format("node {} belongs to two holds along {}; expected at most one", node, "xyz"[axis]));
        }
        held_by = &hold;
      }
    }
  }
  return of_node;
}

std::vector<double> with_point_masses(std::vector<double> mass, const std::vector<PointMass>& points) {
  for (const auto& [node, extra] : points) {
    expect_node("a point mass", node, mass.size());
    if (!(extra >= 0.0 && std::isfinite(extra))) {
      throw InputError(fmt::format("the point mass of node {} is {} kg; expected no negative number", node, extra));
    }
    mass[node] += extra;
  }
  return mass;
}

Inertia every_node_alone(const std::vector<double>& own_mass) {
  Inertia inertia{{}, own_mass, own_mass, own_mass};
  for (int node = 0; node < static_cast<int>(own_mass.size()); ++node) inertia.point.push_back({node, -1});
  return inertia;
}

}  // namespace

Structure::Data::Data(Model model)
    : mesh(std::move(model.mesh)),
      regions(std::move(model.regions)),
      loads(std::move(model.loads)),
      options(checked(model.options)),
      hold_of_node(hold_of_each_node(loads.holds, mesh.nodes.size())),
      elements(mesh, regions, loads.pressures, options.volume_ratio),
      own_mass(with_point_masses(elements.nodal_mass(), loads.masses)),
      x(mesh.nodes),
      v(mesh.nodes.size(), Vec3::Zero()),
      hold_displacement(loads.holds.size()) {
  if (!(loads.damping >= 0.0)) {
    throw InputError(fmt::format("the structure's damping is {} 1/s; expected no negative number", loads.damping));
  }
  if (!(loads.stiffness_damping >= 0.0)) {
    throw InputError(fmt::format("the structure's stiffness-proportional damping is {} s; expected no negative number",
                                 loads.stiffness_damping));
  }
  for (const Hold& hold : loads.holds) hold_moves.push_back(hold.moves());
  if (options.integrator == Integrator::implicit_scheme && needs_explicit_motion()) {
    throw InputError(
        "implicit motion knows no hinged hold and no stiffness-proportional damping; expected explicit motion, or none "
        "of them");
  }
  loads_vary = elements.vary() || std::ranges::find(hold_moves, true) != hold_moves.end() ||
               std::ranges::any_of(loads.forces, [](const NodeLoad& load) { return vary(load.force); });
  for (const NodeLoad& load : loads.forces) {
    for (const int node : load.nodes) expect_node("a load", node, mesh.nodes.size());
  }
  if (loads.stiffness_damping > 0.0) forced_at.resize(mesh.nodes.size());
  set_time(0.0);
  assign_points(every_node_alone(own_mass));
}

Model one_solid(Mesh mesh, const Material& material, double density, std::vector<Hold> holds,
                const StructureOptions& options) {
  Model model{.mesh = std::move(mesh), .regions = {{"", density, Solid{material}}}, .loads = {}, .options = options};
  model.loads.holds = std::move(holds);
  return model;
}

Structure::Structure(Model model) : data_(std::make_unique<Data>(std::move(model))) {}
Structure::~Structure() = default;
Structure::Structure(Structure&&) noexcept = default;

const Mesh& Structure::mesh() const { return data_->mesh; }
int Structure::elements() const { return data_->elements.count(); }
std::span<const Vec3> Structure::position() const { return data_->x; }
std::span<const Vec3> Structure::velocity() const { return data_->v; }
std::span<const double> Structure::own_mass() const { return data_->own_mass; }
std::span<const double> Structure::volume() const { return data_->elements.nodal_volume(); }
std::span<const double> Structure::coupled_volume() const { return data_->elements.coupled_volume(); }

void Structure::set_state(std::span<const Vec3> position, std::span<const Vec3> velocity) {
  assert(position.size() == data_->x.size() && velocity.size() == data_->v.size());
  data_->x.assign(position.begin(), position.end());
  data_->v.assign(velocity.begin(), velocity.end());
  data_->acceleration.clear();
  data_->estimate_largest_frequency();
}

const Inertia& Structure::inertia() const { return data_->inertia; }

void Structure::set_mean_velocity(int point, const Vec3& v) {
  const Point& p = data_->points[point];
  const Vec3 shift = v - p.mean_of(data_->v);
  data_->v[p.a] += shift;
  if (p.is_pair()) data_->v[p.b] += shift;
}

Vec3 Structure::mean_position(int point) const { return data_->points[point].mean_of(data_->x); }
Vec3 Structure::mean_velocity(int point) const { return data_->points[point].mean_of(data_->v); }

int Structure::substeps() const { return data_->substeps; }
double Structure::largest_frequency() const { return data_->largest_frequency; }
void Structure::add_hold_force(std::span<const Vec3> position, std::span<const Vec3> velocity,
                               std::span<Vec3> force) const {
  const std::span<const double> volumes = volume();
  for (std::size_t node = 0; node < force.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const Hold* hold = data_->hold_of_node[node][axis];
      if (hold == nullptr || hold->rigid) continue;
      const double away = data_->mesh.nodes[node][axis] + data_->displacement_of(*hold, axis) - position[node][axis];
      force[node][axis] += volumes[node] * (hold->stiffness * away - hold->damping * velocity[node][axis]);
    }
  }
}

bool Structure::is_held_rigidly(int node) const {
  return std::ranges::all_of(data_->hold_of_node[node], [](const Hold* hold) { return hold && hold->rigid; });
}

double Structure::explicit_substeps(double dt) const { return data_->explicit_substeps(dt, data_->stable_step()); }
double Structure::stable_step() const { return data_->stable_step(); }

Vec3 Structure::reaction() const { return data_->reaction; }

void Structure::internal_force(std::span<const Vec3> position, std::span<Vec3> force) const {
  Elements& elements = data_->elements;
#pragma omp parallel num_threads(elements.threads())
  {
    elements.compute_forces(position);
#pragma omp for schedule(static)
    for (std::size_t node = 0; node < force.size(); ++node) force[node] = elements.nodal_force(static_cast<int>(node));
  }
}

double Structure::elastic_energy() const { return data_->elements.elastic_energy(data_->x); }

double Structure::kinetic_energy() const {
  double twice = 0.0;
  for (const Point& p : data_->points) {
    twice += p.mean.mass * p.mean_of(data_->v).squaredNorm();
    if (p.is_pair()) twice += p.difference.mass * (data_->v[p.a] - data_->v[p.b]).squaredNorm();
  }
  return 0.5 * twice;
}

std::array<double, 2> Structure::volume_ratio_range() const { return data_->elements.volume_ratio_range(data_->x); }

std::array<double, 2> Structure::face_velocity_difference() const {
  double along = 0.0, full = 0.0;
  int pairs = 0;
  for (const Point& p : data_->points) {
    if (!p.is_pair()) continue;
    const Vec3 difference = data_->v[p.a] - data_->v[p.b];
    const double closing = difference.dot((data_->x[p.a] - data_->x[p.b]).normalized());
    along += closing * closing;
    full += difference.squaredNorm();
    ++pairs;
  }
  if (pairs == 0) return {0.0, 0.0};
  return {std::sqrt(along / pairs), std::sqrt(full / pairs)};
}

void Structure::transfer_state(Archive& archive) {
  std::vector<Vec3> reference = data_->mesh.nodes;
  archive.transfer("reference", reference);
  if (reference != data_->mesh.nodes) throw InputError("the mesh of a structure has changed since its state was saved");
  archive.transfer("position", data_->x);
  archive.transfer("velocity", data_->v);
  int has_acceleration = !data_->acceleration.empty();
  archive.transfer("has_acceleration", has_acceleration);
  if (!has_acceleration) return;
  data_->acceleration.resize(data_->x.size());
  archive.transfer("acceleration", data_->acceleration);
}

double Structure::mean_thickness_stretch() const {
  double sum = 0.0;
  int pairs = 0;
  for (const Point& p : data_->points) {
    if (!p.is_pair()) continue;
    sum += (data_->x[p.a] - data_->x[p.b]).norm() / (data_->mesh.nodes[p.a] - data_->mesh.nodes[p.b]).norm();
    ++pairs;
  }
  return pairs == 0 ? 1.0 : sum / pairs;
}

std::array<double, 2> Structure::plane_stress_comparison() const {
  const auto& elements = data_->thin_elements;
  if (elements.empty()) return {1.0, 0.0};
  std::vector<std::array<double, 2>> of_element(elements.size());
#pragma omp parallel for schedule(static) num_threads(data_->elements.threads())
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto& [nodes, direction, material] = elements[e];
    const auto [thickness, in_plane] = sheet_stretch(nodes, direction, data_->mesh.nodes, data_->x);
    const double free = plane_stress_thickness(*material, in_plane[0], in_plane[1]);
    of_element[e] = {free, std::pow(thickness / free - 1.0, 2)};
  }
  double sum = 0.0, squares = 0.0;
  for (const auto& [free, square] : of_element) {
    sum += free;
    squares += square;
  }
  const auto count = static_cast<double>(elements.size());
  return {sum / count, std::sqrt(squares / count)};
}

}  // namespace drogue::fem

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/case_reader.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>
#include <string>
#include <variant>
#include <vector>

#include "app/record.hpp"
#include "case_folder.hpp"
#include "core/error.hpp"

namespace drogue::app {
namespace {

namespace fs = std::filesystem;

const ElasticBody& elastic(const Case& c) { return std::get<ElasticBody>(c.bodies.at(0).kind); }

const fem::Material& material_of(const ElasticBody& body) {
  return std::get<fem::Solid>(body.regions.at(0).kind).material;
}

TEST(CaseReader, reads_every_section) {
  const CaseFolder folder;
  folder.write("case.toml", plate_case);
  const Case c = read_case(folder.path());

  EXPECT_EQ(c.name, folder.path().filename());
  EXPECT_EQ(c.title, "A plate");
  EXPECT_EQ(c.fluid.density, 1.2);
  EXPECT_EQ(c.fluid.viscosity, 0.01);
  EXPECT_EQ(c.fluid.lattice_velocity, 0.05);
  EXPECT_EQ(c.fluid.face[0].type, fluid::Boundary::velocity);
  EXPECT_EQ(c.fluid.face[0].velocity[0](Vec3::Zero(), 0.0), 1.0);
  EXPECT_EQ(c.fluid.face[1].type, fluid::Boundary::outlet);
  EXPECT_EQ(c.domain.periodic, (std::array<bool, 3>{false, false, true}));
  EXPECT_EQ(c.domain.coarsest, 0.0625);
  EXPECT_EQ(c.finest, 0.03125);
  ASSERT_EQ(c.regions.size(), 1u);
  EXPECT_EQ(c.regions[0].spacing, c.finest) << "the finest spacing is a region's default";
  ASSERT_EQ(c.bodies.size(), 1u);
  const ElasticBody& body = elastic(c);
  const auto& plate = std::get<fem::PlateDescription>(body.mesh);
  EXPECT_EQ(plate.normal, 0);
  EXPECT_EQ(plate.elements, (Index3{4, 5, 1}));
  EXPECT_EQ(c.bodies[0].reference_area, 0.4 * 0.5) << "a plate's own area is the default";
  EXPECT_TRUE(std::holds_alternative<fem::NeoHookean>(material_of(body)));
  ASSERT_EQ(body.holds.size(), 1u);
  EXPECT_EQ(body.holds[0].hold.stiffness, 1e6);
  EXPECT_EQ(body.coupling.fluid_density, 1.2);
  EXPECT_EQ(body.coupling.body, "plate");
  EXPECT_EQ(c.end, 2.0);
  EXPECT_EQ(c.results.body, "plate");
  EXPECT_EQ(c.results.stable_window, (std::array<double, 2>{1.0, 2.0})) << "the second half is the default";
  ASSERT_EQ(c.references.size(), 1u);
  EXPECT_EQ(c.references[0].name, "cd_stable");
}

TEST(CaseReader, starts_from_the_inflow_unless_told_otherwise) {
  const CaseFolder folder;
  folder.write("case.toml", plate_case);
  EXPECT_EQ(read_case(folder.path()).fluid.initial_velocity[0](Vec3::Zero(), 0.0), 1.0);
  EXPECT_EQ(read_case(folder.path(), {"fluid.initial=rest"}).fluid.initial_velocity[0](Vec3::Zero(), 0.0), 0.0);
  const Case own = read_case(folder.path(), {"fluid.initial_velocity=['y', 0, 0]"});
  EXPECT_EQ(own.fluid.initial_velocity[0](Vec3(0.0, 0.3, 0.0), 0.0), 0.3);
}

TEST(CaseReader, viscosity_follows_from_the_reynolds_number) {
  const CaseFolder folder;
  folder.write("case.toml", replaced(plate_case, "viscosity = \"1/100\"", "reynolds = 500\nreference_length = 0.4"));
  EXPECT_DOUBLE_EQ(read_case(folder.path()).fluid.viscosity, 0.4 / 500.0);
}

TEST(CaseReader, resolved_case_reads_back_to_itself) {
  const CaseFolder folder;
  folder.write("case.toml", plate_case);
  const std::string first = read_case(folder.path(), {"body.plate.material.poisson=0.25"}).resolved;
  folder.write("again/case.resolved.toml", first);
  const Case again = read_case(folder.path() / "again/case.resolved.toml");
  EXPECT_EQ(again.resolved, first);
  EXPECT_EQ(again.fluid.viscosity, 0.01);
  EXPECT_EQ(std::get<fem::NeoHookean>(material_of(elastic(again))).shear, 400.0);
}

TEST(CaseReader, shipped_cases_read_and_differ_in_their_law_only) {
  const fs::path cases = fs::path(DROGUE_SOURCE_DIR) / "cases";
  const Case neo = read_case(cases / "square_plate");
  const Case svk = read_case(cases / "square_plate_svk");
  EXPECT_TRUE(std::holds_alternative<fem::NeoHookean>(material_of(elastic(neo))));
  EXPECT_TRUE(std::holds_alternative<fem::SaintVenantKirchhoff>(material_of(elastic(svk))));
  EXPECT_EQ(svk.bodies.size(), 1u);
  EXPECT_EQ(elastic(svk).holds.at(0).hold.stiffness, elastic(neo).holds.at(0).hold.stiffness);
  EXPECT_NEAR(neo.fluid.viscosity, 8.128e-5, 1e-18);
  EXPECT_EQ(neo.references.size(), 3u);
  EXPECT_EQ(svk.references.size(), 3u);
}

TEST(Base, own_keys_win_and_named_tables_merge) {
  const CaseFolder folder;
  folder.write("base/case.toml", plate_case);
  folder.write("case.toml", R"(base = "base"
[fluid]
density = 7
[[body]]
name = "plate"
material = { law = "saint_venant_kirchhoff" }
[[grid.region]]
box = [[-0.7, -0.7, -0.7], [0.7, 0.7, 0.7]]
[[grid.region]]
box = [[0, 0, 0], [0.1, 0.1, 0.1]]
)");
  const Case c = read_case(folder.path());
  EXPECT_EQ(c.fluid.density, 7.0);
  EXPECT_EQ(c.fluid.viscosity, 0.01);
  ASSERT_EQ(c.bodies.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<fem::SaintVenantKirchhoff>(material_of(elastic(c))));
  EXPECT_EQ(elastic(c).regions.at(0).density, 1.0);
  EXPECT_EQ(c.regions.size(), 2u) << "arrays without names are replaced";
}

TEST(Base, messages_name_the_file_the_value_stands_in) {
  const CaseFolder folder;
  folder.write("base.toml", replaced(plate_case, "density = 1.2", "density = -3"));
  folder.write("case.toml", "base = \"base.toml\"\n");
  try {
    read_case(folder.path());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("base.toml:14: fluid.density = -3"), std::string::npos) << error.what();
  }
}

TEST(Override, reaches_tables_array_elements_and_names) {
  const CaseFolder folder;
  folder.write("case.toml", plate_case);
  const Case c = read_case(
      folder.path(), {"fluid.density=2", "fluid.viscosity=1/50", "body.0.density=3", "body.plate.material.young = 5e3",
                      "body.plate.hold.0.nodes=all", "domain.lower.0=-3", "title=two words", "output.canopy=0.5",
                      "body.plate.hold.0.patch=0", "body.plate.hold.0.nodes=corners"});
  EXPECT_EQ(c.fluid.density, 2.0);
  EXPECT_EQ(c.fluid.viscosity, 0.02);
  EXPECT_EQ(elastic(c).regions.at(0).density, 3.0);
  EXPECT_DOUBLE_EQ(std::get<fem::NeoHookean>(material_of(elastic(c))).shear, 5e3 / 2.6);
  EXPECT_EQ(elastic(c).holds[0].nodes.name, "corners") << "the last of several wins";
  EXPECT_EQ(c.domain.box.lower, Vec3(-3, -1, -1));
  EXPECT_EQ(c.title, "two words");
  EXPECT_EQ(c.output.canopy, 0.5) << "a table that the file does not have";
}

TEST(Keys, described_list_is_the_schema) {
  const Record record = describe_case();
  std::set<std::string> keys;
  for (const SectionRecord& section : record.sections) {
    for (const KeyRecord& key : section.keys) {
      EXPECT_FALSE(key.doc.empty()) << section.path << " " << key.name;
      EXPECT_FALSE(key.expected.empty()) << section.path << " " << key.name;
      EXPECT_TRUE(keys.insert(join_key(section.path, key.name)).second) << "twice: " << section.path << key.name;
    }
  }
  for (const char* key : {"title",
                          "base",
                          "fluid.solver",
                          "fluid.density",
                          "fluid.viscosity",
                          "fluid.reynolds",
                          "fluid.reference_velocity",
                          "fluid.reference_length",
                          "fluid.lattice_velocity",
                          "fluid.hrr_sigma",
                          "fluid.initial",
                          "fluid.initial_velocity",
                          "fluid.initial_pressure",
                          "domain.lower",
                          "domain.upper",
                          "domain.x_min.type",
                          "domain.z_max.velocity",
                          "domain.y_min.ramp",
                          "domain.x_max.pressure",
                          "domain.x_max.sponge",
                          "grid.coarsest",
                          "grid.finest",
                          "grid.region.box",
                          "grid.region.body",
                          "grid.region.distance",
                          "grid.region.sweep",
                          "grid.region.spacing",
                          "body.name",
                          "body.mesh",
                          "body.mesh.type",
                          "body.mesh.centre",
                          "body.mesh.normal",
                          "body.mesh.size",
                          "body.mesh.thickness",
                          "body.mesh.elements",
                          "body.density",
                          "body.material.law",
                          "body.material.young",
                          "body.material.poisson",
                          "body.material.poisson_stabilisation",
                          "body.hold.nodes",
                          "body.hold.patch",
                          "body.hold.rigid",
                          "body.hold.stiffness",
                          "body.hold.damping",
                          "body.reference_area",
                          "body.dissipation",
                          "body.safety",
                          "body.volume_ratio",
                          "body.coupling.scheme",
                          "body.coupling.delta",
                          "body.coupling.iterations",
                          "body.coupling.spacing",
                          "body.coupling.retraction",
                          "body.shape.type",
                          "body.shape.centre",
                          "body.shape.diameter",
                          "body.shape.axis",
                          "body.shape.length",
                          "body.shape.ends",
                          "body.shape.normal",
                          "body.shape.size",
                          "body.surface",
                          "body.motion.translation",
                          "body.motion.rotation.axis",
                          "body.motion.rotation.centre",
                          "body.motion.rotation.angle",
                          "time.end",
                          "output.history",
                          "output.fluid",
                          "output.canopy",
                          "results.body",
                          "results.stable_window",
                          "results.peak_from",
                          "reference.NAME.value",
                          "reference.NAME.within",
                          "reference.NAME.source"}) {
    EXPECT_TRUE(keys.contains(key)) << key;
  }
}

}  // namespace
}  // namespace drogue::app

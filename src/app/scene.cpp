// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "app/case_checks.hpp"
#include "app/elastic_body.hpp"
#include "app/rigid_body.hpp"
#include "core/process.hpp"

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

fs::path generate_mesh(const Case& c, const Body& body, const fs::path& geometry, const fs::path& folder) {
  const std::string key = fmt::format("body.{}.mesh", body.name);
  fs::create_directories(folder);
  const fs::path mesh = folder / fmt::format("{}.msh", body.name), log = folder / fmt::format("{}.gmsh.log", body.name);
  const int status = run_program({"gmsh", "-3", "-format", "msh41", "-o", mesh.string(), geometry.string()}, log);
  if (status == not_installed) {
    fail(
        c, key,
        fmt::format("= \"{}\" needs gmsh, which is not installed; on Debian: apt-get install gmsh", geometry.string()));
  }
  if (status != 0 || !fs::exists(mesh)) {
    fail(c, key, fmt::format("= \"{}\" could not be meshed by gmsh; see {}", geometry.string(), log.string()));
  }
  return mesh;
}

fem::HexMesh load_mesh(const Case& c, const Body& body, const fs::path& folder) {
  const auto& mesh = std::get<ElasticBody>(body.kind).mesh;
  if (const auto* plate = std::get_if<fem::PlateDescription>(&mesh)) return fem::make_plate(*plate);
  const auto& file = std::get<fs::path>(mesh);
  return fem::read_msh(file.extension() == ".geo" ? generate_mesh(c, body, file, folder) : file);
}

}  // namespace

Meshes load_meshes(const Case& c, const fs::path& folder) {
  Meshes meshes;
  for (const Body& body : c.bodies) {
    if (is_elastic(body)) meshes.emplace(body.name, load_mesh(c, body, folder));
  }
  return meshes;
}

amr::Forest make_forest(const Case& c, const Meshes& meshes) {
  std::map<std::string, std::vector<Vec3>> points;  // of a body: its nodes, or its surface wherever it moves
  for (const Body& body : c.bodies) {
    const auto* rigid = std::get_if<RigidBody>(&body.kind);
    points[body.name] = rigid ? places_of(c, *rigid) : meshes.at(body.name).nodes;
  }
  const double coarsest = c.domain.coarsest;
  std::vector<amr::RefinementCriterion> criteria;
  for (const Region& region : c.regions) {
    criteria.push_back(
        region.box ? amr::refine_box(*region.box, coarsest, region.spacing)
                   : amr::refine_near(points.at(region.body), region.distance, region.sweep, coarsest, region.spacing));
  }
  amr::Forest forest(c.domain, level_of(coarsest, c.finest), amr::any_of(std::move(criteria)));
  for (const Body& body : c.bodies) check_body_in_grid(c, body, points.at(body.name), forest);
  return forest;
}

std::vector<std::unique_ptr<CoupledBody>> make_bodies(const Case& c, const Meshes& meshes, const amr::Forest& forest) {
  std::vector<std::unique_ptr<CoupledBody>> bodies;
  for (const Body& body : c.bodies) {
    if (is_rigid(body)) {
      bodies.push_back(std::make_unique<CoupledRigidBody>(c, body, forest));
    } else {
      bodies.push_back(std::make_unique<CoupledElasticBody>(c, body, meshes.at(body.name), forest));
    }
  }
  return bodies;
}

}  // namespace drogue::app

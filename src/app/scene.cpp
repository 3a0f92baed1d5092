// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene.hpp"

#include <string>
#include <utility>

#include "app/case_checks.hpp"
#include "app/elastic_body.hpp"
#include "app/mesh_reader.hpp"
#include "app/rigid_body.hpp"

namespace drogue::app {

Meshes load_meshes(const Case& c, const std::filesystem::path& folder) {
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

std::vector<std::unique_ptr<CoupledBody>> make_bodies(const Case& c, const Meshes& meshes, const amr::Forest* forest) {
  std::vector<std::unique_ptr<CoupledBody>> bodies;
  for (const Body& body : c.bodies) {
    if (is_rigid(body)) {
      bodies.push_back(std::make_unique<CoupledRigidBody>(c, body, *forest));
    } else {
      bodies.push_back(std::make_unique<CoupledElasticBody>(c, body, meshes.at(body.name), forest));
    }
  }
  return bodies;
}

}  // namespace drogue::app

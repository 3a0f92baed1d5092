// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
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

namespace {

/// Where a body meets the fluid: its surface wherever it moves, or the nodes of a coupled region.
struct Wetted {
  std::string part;  ///< for messages
  std::vector<Vec3> place;
};

std::vector<Wetted> wetted_parts(const Case& c, const Body& body, const Meshes& meshes) {
  if (const auto* rigid = std::get_if<RigidBody>(&body.kind)) return {{"point", places_of(c, *rigid)}};
  const fem::Mesh& mesh = meshes.at(body.name);
  std::vector<Wetted> parts;
  at_key(c, "body." + body.name, [&] {
    for (const fem::Region& region : regions_of(std::get<ElasticBody>(body.kind), mesh)) {
      if (!region.coupled) continue;
      const std::string of = region.elements.empty() ? "" : fmt::format(" of region \"{}\"", region.elements);
      Wetted& part = parts.emplace_back(Wetted{"node" + of, {}});
      for (const int node : nodes_of(mesh, region)) part.place.push_back(mesh.nodes[node]);
    }
  });
  return parts;
}

}  // namespace

amr::Forest make_forest(const Case& c, const Meshes& meshes) {
  std::map<std::string, std::vector<Wetted>> parts;
  std::map<std::string, std::vector<Vec3>> points;
  for (const Body& body : c.bodies) {
    parts[body.name] = wetted_parts(c, body, meshes);
    std::vector<Vec3>& all = points[body.name];
    for (const Wetted& part : parts[body.name]) all.insert(all.end(), part.place.begin(), part.place.end());
  }
  const double coarsest = c.domain.coarsest;
  std::vector<amr::RefinementCriterion> criteria;
  for (const Region& region : c.regions) {
    criteria.push_back(
        region.box ? amr::refine_box(*region.box, coarsest, region.spacing)
                   : amr::refine_near(points.at(region.body), region.distance, region.sweep, coarsest, region.spacing));
  }
  std::optional<amr::Forest> forest;
  at_key(c, "grid.finest",
         [&] { forest.emplace(c.domain, level_of(coarsest, c.finest), amr::any_of(std::move(criteria))); });
  for (const Body& body : c.bodies) {
    for (const auto& [part, place] : parts.at(body.name)) check_body_in_grid(c, body, part, place, *forest);
  }
  return std::move(*forest);
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

std::unique_ptr<TouchingBodies> make_touching(const Case& c, const std::vector<std::unique_ptr<CoupledBody>>& bodies) {
  if (!c.contact) return nullptr;
  std::vector<CoupledElasticBody*> elastic;
  for (const auto& body : bodies) {
    if (auto* found = dynamic_cast<CoupledElasticBody*>(body.get())) elastic.push_back(found);
  }
  std::unique_ptr<TouchingBodies> touching;
  at_key(c, "contact", [&] { touching = std::make_unique<TouchingBodies>(std::move(elastic), *c.contact); });
  return touching;
}

}  // namespace drogue::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <numeric>
#include <string>
#include <utility>

#include "app/case_checks.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"

extern char** environ;

namespace drogue::app {

namespace {

namespace fs = std::filesystem;

/// Runs a program, its output into `log`, and returns its exit status, or -1 if there is no such program.
int run_program(std::vector<std::string> words, const fs::path& log) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed) return -1;
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

fs::path generate_mesh(const Case& c, const Body& body, const fs::path& geometry, const fs::path& folder) {
  const std::string key = fmt::format("body.{}.mesh", body.name);
  fs::create_directories(folder);
  const fs::path mesh = folder / fmt::format("{}.msh", body.name), log = folder / fmt::format("{}.gmsh.log", body.name);
  const int status = run_program({"gmsh", "-3", "-format", "msh41", "-o", mesh.string(), geometry.string()}, log);
  if (status < 0 || status == 127) {
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
  if (const auto* plate = std::get_if<fem::PlateDescription>(&body.mesh)) return fem::make_plate(*plate);
  const auto& file = std::get<fs::path>(body.mesh);
  return fem::read_msh(file.extension() == ".geo" ? generate_mesh(c, body, file, folder) : file);
}

std::vector<fem::Hold> make_holds(const Case& c, const Body& body, const fem::HexMesh& mesh) {
  std::vector<fem::Hold> holds;
  for (const HoldDescription& hold : body.holds) {
    holds.push_back({held_nodes(c, body, hold, mesh), hold.rigid, hold.stiffness, hold.damping});
  }
  return holds;
}

int point_nearest(const fem::Structure& structure, const Vec3& place) {
  int nearest = 0;
  const int points = static_cast<int>(structure.inertia().point.size());
  for (int p = 1; p < points; ++p) {
    const double distance = (structure.mean_position(p) - place).squaredNorm();
    if (distance < (structure.mean_position(nearest) - place).squaredNorm()) nearest = p;
  }
  return nearest;
}

Vec3 middle(const fem::HexMesh& mesh) {
  Vec3 lower = mesh.nodes.front(), upper = lower;
  for (const Vec3& node : mesh.nodes) {
    lower = lower.cwiseMin(node);
    upper = upper.cwiseMax(node);
  }
  return 0.5 * (lower + upper);
}

}  // namespace

std::vector<fem::HexMesh> load_meshes(const Case& c, const fs::path& folder) {
  std::vector<fem::HexMesh> meshes;
  for (const Body& body : c.bodies) meshes.push_back(load_mesh(c, body, folder));
  return meshes;
}

amr::Forest make_forest(const Case& c, std::span<const fem::HexMesh> meshes) {
  const double coarsest = c.domain.coarsest;
  std::vector<amr::RefinementCriterion> criteria;
  for (const Region& region : c.regions) {
    if (region.box) {
      criteria.push_back(amr::refine_box(*region.box, coarsest, region.spacing));
      continue;
    }
    for (std::size_t i = 0; i < c.bodies.size(); ++i) {
      if (c.bodies[i].name != region.body) continue;
      criteria.push_back(amr::refine_near(meshes[i].nodes, region.distance, region.sweep, coarsest, region.spacing));
    }
  }
  amr::Forest forest(c.domain, level_of(coarsest, c.finest), amr::any_of(std::move(criteria)));
  for (std::size_t i = 0; i < c.bodies.size(); ++i) check_body_in_grid(c, c.bodies[i], meshes[i], forest);
  return forest;
}

std::vector<int> held_nodes(const Case& c, const Body& body, const HoldDescription& hold, const fem::HexMesh& mesh) {
  std::vector<int> nodes;
  std::vector<std::string> known{"corners", "all"};
  for (const auto& [name, set] : mesh.node_sets) known.push_back(name);
  if (hold.nodes == "corners") {
    nodes = fem::corner_nodes(mesh, hold.patch);
  } else if (hold.nodes == "all") {
    nodes.resize(mesh.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
  } else if (const auto set = mesh.node_sets.find(hold.nodes); set != mesh.node_sets.end()) {
    nodes = set->second;
  } else {
    fail(c, fmt::format("body.{}.hold", body.name),
         fmt::format("names the node set \"{}\", which its mesh does not have{}", hold.nodes,
                     did_you_mean(hold.nodes, known)));
  }
  if (nodes.empty()) {
    fail(c, fmt::format("body.{}.hold", body.name), fmt::format("holds no node: the set \"{}\" is empty", hold.nodes));
  }
  return nodes;
}

CoupledBody::CoupledBody(const Case& c, const Body& body, fem::HexMesh mesh, const amr::Forest& forest)
    : description(body),
      structure(mesh, body.material, body.structure, make_holds(c, body, mesh)),
      coupling(structure, forest, body.coupling),
      centre_point(point_nearest(structure, middle(mesh))),
      centre_reference(structure.mean_position(centre_point)) {}

void CoupledBody::transfer_state(Archive& archive) {
  archive.transfer("structure", structure);
  archive.transfer("coupling", coupling);
}

std::vector<std::unique_ptr<CoupledBody>> make_bodies(const Case& c, std::span<const fem::HexMesh> meshes,
                                                      const amr::Forest& forest) {
  std::vector<std::unique_ptr<CoupledBody>> bodies;
  for (std::size_t i = 0; i < c.bodies.size(); ++i) {
    bodies.push_back(std::make_unique<CoupledBody>(c, c.bodies[i], meshes[i], forest));
  }
  return bodies;
}

}  // namespace drogue::app

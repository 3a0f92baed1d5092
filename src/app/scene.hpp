// SPDX-License-Identifier: GPL-3.0-or-later
// From the description of a case to what is simulated: meshes, the grid around them, bodies coupled to it.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "amr/forest.hpp"
#include "app/case.hpp"
#include "fem/hex_mesh.hpp"
#include "fem/structure.hpp"
#include "fsi/coupling.hpp"

namespace drogue::app {

/// The mesh of every body; a `.geo` file is meshed by gmsh into `folder`. Throws InputError.
std::vector<fem::HexMesh> load_meshes(const Case& c, const std::filesystem::path& folder);

/// The grid of a case. Throws InputError if a body does not lie in its finest cells.
amr::Forest make_forest(const Case& c, std::span<const fem::HexMesh> meshes);

/// The nodes of a hold on a mesh. Throws InputError if there are none.
std::vector<int> held_nodes(const Case& c, const Body& body, const HoldDescription& hold, const fem::HexMesh& mesh);

/// A body and how it meets the fluid. Stays where it is made: the coupling keeps a reference to the structure.
struct CoupledBody {
  /// `forest` outlives it. Throws InputError for a mesh or values that cannot be run.
  CoupledBody(const Case& c, const Body& body, fem::HexMesh mesh, const amr::Forest& forest);
  CoupledBody(const CoupledBody&) = delete;
  CoupledBody& operator=(const CoupledBody&) = delete;

  void transfer_state(Archive& archive);

  const Body& description;
  fem::Structure structure;
  fsi::Coupling coupling;
  int centre_point;       ///< of the inertia: nearest the middle of the reference mesh
  Vec3 centre_reference;  ///< where it was [m]
};

std::vector<std::unique_ptr<CoupledBody>> make_bodies(const Case& c, std::span<const fem::HexMesh> meshes,
                                                      const amr::Forest& forest);

}  // namespace drogue::app

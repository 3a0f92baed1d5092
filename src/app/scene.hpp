// SPDX-License-Identifier: GPL-3.0-or-later
// From the description of a case to what is simulated: meshes, the grid around the bodies, bodies coupled to it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "amr/forest.hpp"
#include "app/case.hpp"
#include "app/coupled_body.hpp"
#include "app/touching_bodies.hpp"
#include "fem/mesh.hpp"

namespace drogue::app {

/// Of the elastic bodies, by name.
using Meshes = std::map<std::string, fem::Mesh>;

/// A `.geo` file is meshed by gmsh into `folder`. Throws InputError.
Meshes load_meshes(const Case& c, const std::filesystem::path& folder);

/// The grid of a case. Throws InputError if a body does not lie in its finest cells, wherever it moves as prescribed.
amr::Forest make_forest(const Case& c, const Meshes& meshes);

/// In the order of the case; `forest`, null without a fluid, outlives them. Throws InputError for a mesh or values that
/// cannot be run.
std::vector<std::unique_ptr<CoupledBody>> make_bodies(const Case& c, const Meshes& meshes, const amr::Forest* forest);

/// All elastic ones of the `bodies`, which outlive it, if the case asks for contact; null otherwise. Throws InputError.
std::unique_ptr<TouchingBodies> make_touching(const Case& c, const std::vector<std::unique_ptr<CoupledBody>>& bodies);

}  // namespace drogue::app

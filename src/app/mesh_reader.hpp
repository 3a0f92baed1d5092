// SPDX-License-Identifier: GPL-3.0-or-later
// Reads what an elastic body's mesh is, and makes it.
#pragma once

#include "app/case.hpp"
#include "app/section.hpp"

namespace drogue::app {

/// Throws InputError.
MeshDescription read_mesh_description(Section& body);

/// Area of a flat mesh that is described [m^2]; nothing of others.
std::optional<double> area_of(const MeshDescription& mesh);

/// The mesh of a body with its points and cables; a `.geo` file is meshed by gmsh into `folder`. Throws InputError.
fem::Mesh load_mesh(const Case& c, const Body& body, const std::filesystem::path& folder);

}  // namespace drogue::app

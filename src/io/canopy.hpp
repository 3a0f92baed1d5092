// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as VTK's XML UnstructuredGrid (.vtu), binary appended, as ParaView and VTK 9 read it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "fem/mesh.hpp"
#include "geometry/triangle_mesh.hpp"

namespace drogue::io {

/// Writes the mesh at `position` [m] with point data Displacement [m] and Velocity [m/s], and one value per element of
/// each array of `cell_data`. `time` [s] is stored as the field TimeValue, which ParaView shows. Throws
/// std::runtime_error naming the file, std::invalid_argument for an array of the wrong length.
void write_canopy(const std::filesystem::path& file, const fem::Mesh& mesh, std::span<const Vec3> position,
                  std::span<const Vec3> velocity, const std::map<std::string, std::vector<double>>& cell_data,
                  std::optional<double> time = std::nullopt);

/// Writes the surface of a rigid body, its points now at `position` [m], with point data Displacement [m].
void write_surface(const std::filesystem::path& file, const geometry::TriangleMesh& mesh,
                   std::span<const Vec3> position, double time);

}  // namespace drogue::io

// SPDX-License-Identifier: GPL-3.0-or-later
// The flow at one instant as VTKHDF OverlappingAMR, which ParaView 5.11 and VTK 9.2 open.
//
//   /                  attribute Time [s] (outside of what VTK reads)
//   /VTKHDF            attributes Version, Type, Origin [m], GridDescription
//   /VTKHDF/Level<l>   attribute Spacing [m]; AMRBox: first and last cell ilo ihi jlo jhi klo khi of each block, in
//   cells
//                      of the level; CellData/Velocity [m/s], CellData/Pressure [Pa]: block after block, x fastest
//
// Leaves and parents are written, so every level lies inside the one above and level 0 fills the domain.
// Format: "VTK File Formats", Kitware, section VTKHDF.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "core/types.hpp"
#include "fluid/fluid_solver.hpp"

namespace drogue::io {

/// Writes all levels of `fluid` at its present time: 16 bytes a cell, or with `gzip` 1 to 9 about half of that in five
/// to ten times the time. Throws std::runtime_error naming the file.
void write_fluid(const std::filesystem::path& file, const fluid::FluidSolver& fluid, int gzip = 0);

struct FluidSnapshot {
  struct Level {
    double spacing = 0.0;                   ///< [m]
    std::vector<Index3> block;              ///< block coordinates within the level
    std::vector<float> velocity, pressure;  ///< [block][z][y][x][component] [m/s], [block][z][y][x] [Pa]
  };
  double time = 0.0;           ///< [s]
  Vec3 origin = Vec3::Zero();  ///< lower corner of the domain [m]
  std::vector<Level> levels;
};

/// Reads what write_fluid wrote. Throws std::runtime_error naming the file.
FluidSnapshot read_fluid(const std::filesystem::path& file);
/// Its time alone [s].
double read_fluid_time(const std::filesystem::path& file);

}  // namespace drogue::io

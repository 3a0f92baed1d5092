// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that are described by a few numbers. Every function throws InputError for numbers that make no mesh.
#pragma once

#include "fem/mesh.hpp"

namespace drogue::fem {

/// A rectangular plate of hexahedra: `normal` is the axis (0, 1, 2) it is thin in; `size` along the two other axes in
/// cyclic order.
struct PlateDescription {
  Vec3 centre = Vec3::Zero();  ///< of the mid-surface [m]
  int normal = 0;
  std::array<double, 2> size{};          ///< [m]
  double thickness = 0.0;                ///< [m]
  std::array<int, 3> elements{1, 1, 1};  ///< along the two sides, through the thickness
};
Mesh make_plate(const PlateDescription& plate);

/// A flat sheet of quadrilaterals between four corners, in order around, or of the triangles that halve them.
struct SheetDescription {
  std::array<Vec3, 4> corner{};       ///< [m]
  std::array<int, 2> elements{1, 1};  ///< from the first corner to the second, from there to the third
  bool triangles = false;
};
Mesh make_sheet(const SheetDescription& sheet);

/// A flat disk: a square of `elements[0]`^2 quadrilaterals in the middle, and `elements[1]` layers around it. Its node
/// sets are "centre" and "rim".
struct DiskDescription {
  Vec3 centre = Vec3::Zero();  ///< [m]
  int normal = 0;
  double radius = 0.0;  ///< [m]
  std::array<int, 2> elements{1, 1};
  bool triangles = false;
};
Mesh make_disk(const DiskDescription& disk);

/// The solid of `layers` hexahedra that a sheet of quadrilaterals sweeps out when it moves by `way` [m].
Mesh extruded(const Mesh& sheet, const Vec3& way, int layers);

/// Adds a node, and names it. Returns its number.
int add_point(Mesh& mesh, const std::string& name, const Vec3& place);

/// Adds a straight line of elements between two nodes, as region and node set `name`.
void add_line(Mesh& mesh, const std::string& name, int from, int to, int elements);

}  // namespace drogue::fem

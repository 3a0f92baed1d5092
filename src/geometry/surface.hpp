// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a rigid body as points that each stand for a piece of it, and the shapes that are sampled so. A shape
// is a function here and a line in the list of app/shape_reader.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/types.hpp"
#include "geometry/triangle_mesh.hpp"

namespace drogue::geometry {

struct Surface {
  std::vector<Vec3> point;   ///< [m]
  std::vector<double> area;  ///< of the piece that a point stands for [m^2]; the sum is the area of the surface
  std::vector<Vec3> normal;  ///< unit, outward where a volume is enclosed
  Solid enclosed;            ///< without volume if the surface is open: a sheet
  TriangleMesh picture;      ///< the surface for the eye
};

/// What a case describes by its dimensions or by a file.
struct Shape {
  Vec3 centre = Vec3::Zero();   ///< [m]
  double reference_area = 0.0;  ///< of force coefficients [m^2]; 0 if the shape suggests none
  double width = 0.0;           ///< across a flow, in which cells and wakes are counted [m]; 0 if there is none
  bool encloses_volume = true;
  double span = 0.0;  ///< [m] along `span_axis` of a body whose open ends must meet their periodic images; 0 otherwise
  int span_axis = 0;
  /// Points about `spacing` [m] apart, along the rows of a regular grid where the shape has such. May throw InputError.
  std::function<Surface(double spacing)> sample;
};

enum class Ends { capped, open };

Shape sphere(const Vec3& centre, double diameter);
/// `axis` is 0, 1 or 2. Open ends are for a cylinder that spans a periodic direction: it encloses its volume all the
/// same.
Shape cylinder(const Vec3& centre, int axis, double diameter, double length, Ends ends);
/// A rectangle without thickness: `normal` is 0, 1 or 2, `size` [m] along the two other axes in cyclic order.
Shape plate(const Vec3& centre, int normal, const std::array<double, 2>& size);
Shape disk(const Vec3& centre, int normal, double diameter);
/// The triangles of a file .stl or .msh; an area of reference it does not suggest. Throws InputError naming the file.
Shape triangulated(const std::filesystem::path& file);

/// Points of a triangulated surface that are no nearer to each other than 0.85 `spacing` [m] on the same side of a thin
/// body, and leave no gap of more than that either; every piece of the surface counts for the point nearest to it.
Surface sample(const TriangleMesh& mesh, double spacing);

}  // namespace drogue::geometry

// SPDX-License-Identifier: GPL-3.0-or-later
// What the elements of a mesh are made of.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/expression.hpp"
#include "core/types.hpp"
#include "fem/material.hpp"
#include "fem/mesh.hpp"

namespace drogue::fem {

/// How the eight nodes of a hexahedron make its gradient.
enum class Hexahedron {
  trilinear,      ///< as the field between them; locks in bending and near incompressibility
  assumed_strain  ///< see assumed_strain_hexahedra.cpp
};

/// Hexahedra.
struct Solid {
  Material material;
  Hexahedron element = Hexahedron::assumed_strain;
};

/// Quadrilaterals and triangles: stress in their plane alone, no bending.
struct Membrane {
  MembraneMaterial material;
  double thickness = 0.0;     ///< of the reference state [m]
  Vec3 warp = Vec3::UnitX();  ///< whose projection on the element is its material's first axis
};

/// Lines: stress along them alone.
struct Cable {
  LinearCable material;
  double section = 0.0;       ///< of the reference state [m^2]
  double length_ratio = 1.0;  ///< of the unstressed length to that in the mesh: more than 1 sags, less is under tension
};

/// Stress that elements build up by themselves along a fibre f0 (paper eq. 13): P_a = J T F f0 f0^T. The fibre of a
/// membrane is its warp, that of a cable the cable.
struct ActiveStress {
  Expression tension;              ///< T of time alone [Pa]; zero without
  Vec3 direction = Vec3::UnitX();  ///< f0 in a solid, a unit vector
};

struct Region {
  std::string elements;  ///< a set of the mesh; empty for all elements of the kind's families
  double density = 0.0;  ///< own mass per reference volume [kg/m^3]; 0 only of what is coupled
  std::variant<Cable, Solid, Membrane> kind;
  ActiveStress active{};
  bool coupled = true;  ///< with what surrounds the body; elsewhere than in it otherwise
};

/// Those of its kind's families in its set. Throws InputError for a set that the mesh does not name.
ElementSet elements_of(const Mesh& mesh, const Region& region);

/// Nodes of its elements, in ascending order.
std::vector<int> nodes_of(const Mesh& mesh, const Region& region);

}  // namespace drogue::fem

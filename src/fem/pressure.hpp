// SPDX-License-Identifier: GPL-3.0-or-later
// Follower pressure: f_a = p times the integral of N_a n da over the deformed faces, n the side from which the nodes
// appear in counter-clockwise order. Over a closed surface it has no resultant.
#pragma once

#include <memory>

#include "fem/element_group.hpp"

namespace drogue::fem {

class PressureGroup : public ForceGroup {
 public:
  using ForceGroup::ForceGroup;
  void set_pressure(double pressure) { pressure_ = pressure; }  ///< [Pa]

 protected:
  double pressure_ = 0.0;
};

/// Faces of the quadrilaterals and triangles of a set; nothing for a family without any.
std::vector<std::unique_ptr<PressureGroup>> make_pressure(const Mesh& mesh, const ElementSet& elements);

}  // namespace drogue::fem

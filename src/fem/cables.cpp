// SPDX-License-Identifier: GPL-3.0-or-later
// Cables: straight lines of two nodes that bear stress along themselves alone, P(lambda) on the reference section,
// lambda the length over that of the reference state.
#include "fem/batched_group.hpp"

namespace drogue::fem {
namespace {

struct CableBatch {
  static constexpr int nodes = 2;
  static constexpr const char* name = "cable";
  static constexpr const char* expected = "two nodes at different places";

  struct Point {
    Pack weight;  ///< section times reference length [m^3]
  };
  BatchNodes<2> node;
  std::array<Point, 1> point;
  Pack inverse_length;  ///< [1/m]
};

void prepare_geometry(CableBatch& batch, const Cable& cable, std::span<const Vec3> reference) {
  for (int lane = 0; lane < lanes; ++lane) {
    const Vec3 way = reference[batch.node[1][lane]] - reference[batch.node[0][lane]];
    const double length = cable.length_ratio * way.norm();
    batch.inverse_length[lane] = 1.0 / length;
    batch.point[0].weight[lane] = cable.section * length;
  }
}

/// Stretch, and the present vector from node to node over the reference length.
struct Line {
  Pack way[3], stretch;

  Line(const CableBatch& batch, std::span<const Vec3> x) {
    Pack square{};
    for (int axis = 0; axis < 3; ++axis) {
      way[axis] = batch.inverse_length * (gather(batch.node[1], x, axis) - gather(batch.node[0], x, axis));
      square += way[axis] * way[axis];
    }
    stretch = square_root(square);
  }
  /// For division: a cable whose ends meet has no direction, so its force there is zero.
  Pack divisor() const { return stretch == 0.0 ? splat<Pack>(1.0) : stretch; }
};

VolumeRatio nodal_forces(const LinearCable& law, const ActiveFibre& fibre, const CableBatch& batch,
                         std::span<const Vec3> x, NodalForces<2>& forces) {
  const Line line(batch, x);
  // A cable does not contract sideways, so J is its stretch, and P_a = T lambda^2.
  const Pack stress = law.stress(line.stretch) + fibre.tension * line.stretch * line.stretch;
  const Pack pull = batch.point[0].weight * batch.inverse_length * stress / line.divisor();
  for (int axis = 0; axis < 3; ++axis) {
    forces.component[0][axis] = pull * line.way[axis];
    forces.component[1][axis] = -forces.component[0][axis];
  }
  VolumeRatio range;
  range.extend(law.volume_ratio(line.stretch));
  return range;
}

/// With N the tension and n the direction: (dN/dl) n n^T along the cable, N / l across it.
void add_tangent(const LinearCable& law, const ActiveFibre& fibre, const CableBatch& batch, std::span<const Vec3> x,
                 Stiffness<2>& stiffness) {
  const Line line(batch, x);
  const Pack scale = batch.point[0].weight * batch.inverse_length * batch.inverse_length, l = line.stretch;
  const Pack along = scale * (law.tangent(l) + 2.0 * fibre.tension * l);
  const Pack across = scale * (law.stress(l) + fibre.tension * l * l) / line.divisor();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Pack projection = line.way[i] * line.way[k] / (line.divisor() * line.divisor());
      const Pack entry = (along - across) * projection + (i == k ? across : Pack{});
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) stiffness.component[a][i][b][k] += a == b ? entry : -entry;
      }
    }
  }
}

Pack energy(const LinearCable& law, const CableBatch& batch, std::span<const Vec3> x) {
  return batch.point[0].weight * law.energy(Line(batch, x).stretch);
}

VolumeRatio volume_ratio(const LinearCable& law, const CableBatch& batch, std::span<const Vec3> x) {
  VolumeRatio range;
  range.extend(law.volume_ratio(Line(batch, x).stretch));
  return range;
}

void lump_volumes(const CableBatch& batch, int lane, std::span<double> volume) {
  for (const auto& node : batch.node) volume[node[lane]] += 0.5 * batch.point[0].weight[lane];
}

/// In the parent interval [-1, 1] the derivative is 2 / L; along the cable its modulus resists, also of a slack one,
/// which may be taut in a moment, and across it the tension.
Tensor<Pack> directional_stiffness(const LinearCable& law, const CableBatch& batch, std::span<const Vec3> x) {
  const Line line(batch, x);
  const Pack across = law.stress(line.stretch) / line.divisor();
  const Pack stiffest = larger(across, splat<Pack>(law.young));
  return directional_stiffness_of({4.0 * batch.inverse_length * batch.inverse_length * stiffest, Pack{}, Pack{}});
}

}  // namespace

std::unique_ptr<ElementGroup> make_cables(const Cable& cable, const GroupDescription& group, const Mesh& mesh,
                                          const std::vector<int>& elements) {
  if (!(cable.length_ratio > 0.0)) {
    throw InputError(fmt::format("a cable is {} times as long as its line in the mesh; expected a positive ratio",
                                 cable.length_ratio));
  }
  if (!(cable.section > 0.0)) {
    throw InputError(fmt::format("the section of a cable is {} m^2; expected a positive area", cable.section));
  }
  return make_group<CableBatch>(cable.material, cable, group, mesh.nodes, mesh.lines, elements);
}

}  // namespace drogue::fem

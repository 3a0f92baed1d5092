// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/interface_plan.hpp"

#include <algorithm>
#include <utility>

#include "lbm/level_transfer.hpp"
#include "lbm/lines.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

Index3 operator+(const Index3& a, const Index3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Index3 unit(int axis, int sign) {
  Index3 offset{0, 0, 0};
  offset[axis] = sign;
  return offset;
}

enum class Side { inner, outer, wall, other };  // a wall is one without slip

/// One level of the interface.
class InterfaceLevel {
 public:
  InterfaceLevel(const amr::Forest& forest, const fluid::Specification& specification, amr::Kind inner, amr::Kind outer)
      : forest_(forest), specification_(specification), inner_(inner), outer_(outer) {}

  int beside(int id, const Index3& offset) const {
    return id == amr::none ? id : forest_.block(id).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
  }

  Side side(int id) const {
    if (id == amr::none) return Side::other;
    const amr::Kind kind = forest_.block(id).kind;
    if (kind == inner_) return Side::inner;
    if (kind == outer_) return Side::outer;
    return kind == amr::Kind::boundary && beyond_walls_only(id) ? Side::wall : Side::other;
  }

  InterfaceFace face(int inner, int face) const {
    const int axis = face / 2;
    const int outer = beside(inner, unit(axis, face & 1 ? 1 : -1));
    InterfaceFace result{inner, outer, face, {}};
    for (int e = 0; e < 4; ++e) {
      const int next = beside(inner, unit(e < 2 ? along_axis(axis) : across_axis(axis), e & 1 ? 1 : -1));
      result.open[e] = next != amr::none && forest_.block(next).kind == amr::Kind::boundary && is_open(next);
    }
    return result;
  }

  /// Weight of the population along `c` = f + g of the line of cells in `block` at the edge it crosses, in the mass of
  /// the inner side. Sums over faces count it once for each face of the interface it leaves through; it counts if it
  /// arrives. A population that comes from an image in a wall arrives on one side of the interface but was
  /// balanced on the other.
  int weight(int block, const Index3& f, const Index3& g) const {
    const int to = beside(block, f + g), at_f = beside(block, f), at_g = beside(block, g);
    const auto misses = [&](Side s) { return (side(to) == s) - (side(at_f) == s) - (side(at_g) == s); };
    for (const int id : {to, at_f, at_g})
      if (id == amr::none || (forest_.block(id).kind == amr::Kind::boundary && side(id) != Side::wall)) return 0;
    if (side(block) == Side::inner) return -misses(Side::outer);
    if (side(block) == Side::outer) return misses(Side::inner);
    if (side(block) != Side::wall) return 0;
    const int image_of = side(at_f) == Side::wall ? at_g : at_f;
    const auto is_fluid = [&](int id) { return side(id) == Side::inner || side(id) == Side::outer; };
    if (!is_fluid(to) || !is_fluid(image_of)) return 0;
    return (side(to) == Side::inner) - (side(image_of) == Side::inner);
  }

 private:
  bool is_open(int boundary) const {
    return for_faces_beyond(
        boundary, [](fluid::Boundary b) { return b == fluid::Boundary::velocity || b == fluid::Boundary::outlet; });
  }
  bool beyond_walls_only(int boundary) const {
    return !for_faces_beyond(boundary, [](fluid::Boundary b) { return b != fluid::Boundary::no_slip; });
  }
  template <class Predicate>
  bool for_faces_beyond(int boundary, Predicate any) const {
    return std::ranges::any_of(forest_.faces_beyond(boundary),
                               [&](int face) { return any(specification_.face[face].type); });
  }

  const amr::Forest& forest_;
  const fluid::Specification& specification_;
  const amr::Kind inner_, outer_;
};

/// First cell of the line of a block along the edge towards f + g.
Index3 edge_line(const Index3& f, const Index3& g) {
  Index3 first{0, 0, 0};
  for (int a = 0; a < 3; ++a)
    if (f[a] + g[a] > 0) first[a] = n - 1;
  return first;
}

ByLeaf<DiagonalTerm> diagonal_terms(const amr::Forest& forest, int level, const InterfaceLevel& interface) {
  ByLeaf<DiagonalTerm> terms(forest, level);
  const auto all = forest.range(level);
  for (int id = all.begin; id < all.end; ++id)
    for (int along = 0; along < 3; ++along)
      for (int signs = 0; signs < 4; ++signs) {
        const Index3 f = unit((along + 1) % 3, signs & 1 ? 1 : -1), g = unit((along + 2) % 3, signs & 2 ? 1 : -1);
        const int weight = interface.weight(id, f, g);
        if (weight == 0) continue;
        int leaf = amr::none;  // there is one, an interface lies between leaves and others
        for (const int around : {id, interface.beside(id, f), interface.beside(id, g), interface.beside(id, f + g)})
          if (forest.block(around).kind == amr::Kind::leaf) leaf = around;
        const Index3 first = edge_line(f, g);
        terms[leaf].push_back({id, along, weight, first, f + g, is_in_columns(forest, id, first, along)});
      }
  return terms;
}

}  // namespace

Interface plan_interface(const amr::Forest& forest, const fluid::Specification& specification, int coarse) {
  const InterfaceLevel above(forest, specification, amr::Kind::leaf, amr::Kind::parent);
  const InterfaceLevel below(forest, specification, amr::Kind::ghost, amr::Kind::leaf);
  Interface plan{{ByLeaf<InterfaceFace>(forest, coarse), diagonal_terms(forest, coarse, above)},
                 {ByLeaf<InterfaceFace>(forest, coarse + 1), diagonal_terms(forest, coarse + 1, below)}};
  const auto leaves = forest.range(coarse, amr::Kind::leaf);
  for (int id = leaves.begin; id < leaves.end; ++id)
    for (int f = 0; f < 6; ++f) {
      const int axis = f / 2;
      if (above.side(above.beside(id, unit(axis, f & 1 ? 1 : -1))) != Side::outer) continue;
      plan.coarse.faces[id].push_back(above.face(id, f));
      for (int quarter = 0; quarter < 4; ++quarter) {
        Index3 ghost = forest.block(id).index;
        for (int a = 0; a < 3; ++a) ghost[a] *= 2;
        ghost[axis] += f & 1;
        ghost[along_axis(axis)] += quarter & 1;
        ghost[across_axis(axis)] += quarter >> 1;
        const InterfaceFace face = below.face(forest.find(coarse + 1, ghost), f);
        plan.fine.faces[face.outer].push_back(face);
      }
    }
  return plan;
}

}  // namespace drogue::lbm

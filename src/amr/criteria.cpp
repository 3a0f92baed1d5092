// SPDX-License-Identifier: GPL-3.0-or-later
// Where to refine: around boxes, and around points together with the way they are going to move.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "amr/forest.hpp"
#include "core/error.hpp"

namespace drogue::amr {
namespace {

constexpr double round_off = 1e-9;  // relative; far above that of coordinates, far below any cell

bool is_coarser(int level, double coarsest, double spacing) {
  return std::ldexp(coarsest, -level) > spacing * (1 + round_off);
}

void check_spacing(double coarsest, double spacing) {
  if (!(spacing > 0) || !(coarsest > 0)) {
    throw InputError(fmt::format("refinement from a cell edge of {} m to {} m was asked for, but both must be positive",
                                 coarsest, spacing));
  }
}

/// Whether a region and a block share volume. A face in common does not count, or a region that ends on block faces
/// would refine the blocks around it too, depending on round-off; but a flat region has only faces.
bool touches(const Box& region, const Box& block) {
  const double slack = round_off * block.size().maxCoeff();
  for (int a = 0; a < 3; ++a) {
    const bool flat = region.upper[a] - region.lower[a] <= 2 * slack;
    const double margin = flat ? slack : -slack;
    if (region.lower[a] > block.upper[a] + margin || region.upper[a] < block.lower[a] - margin) return false;
  }
  return true;
}

/// Whether `start + s sweep`, s in [0, 1], meets the closed box: the segment is clipped by one slab after the other.
bool segment_meets(const Box& box, const Vec3& start, const Vec3& sweep) {
  double enter = 0, leave = 1;
  for (int a = 0; a < 3; ++a) {
    const double to_lower = box.lower[a] - start[a], to_upper = box.upper[a] - start[a];
    if (sweep[a] == 0) {
      if (to_lower > 0 || to_upper < 0) return false;
      continue;
    }
    const double s = to_lower / sweep[a], t = to_upper / sweep[a];
    enter = std::max(enter, std::min(s, t));
    leave = std::min(leave, std::max(s, t));
  }
  return enter <= leave;
}

/// Points swept along one vector, in a binary tree of bounding boxes: node n has the children 2n and 2n + 1, and a
/// node without children is one point. A question costs about log2(number of points) clippings.
class SweptPoints {
 public:
  SweptPoints(std::span<const Vec3> points, const Vec3& sweep) : size_(points.size()), sweep_(sweep) {
    if (points.empty()) return;
    bounds_.resize(2 * std::bit_ceil(size_));
    std::vector<Vec3> copy(points.begin(), points.end());
    build(1, copy);
  }

  /// Whether the path of a point comes within `distance` of the box, measured in the maximum norm: the box grown by
  /// `distance` on every side meets the path. That includes all that is as near in the usual norm.
  bool within(double distance, const Box& box) const {
    const Vec3 margin = Vec3::Constant(distance);
    return size_ > 0 && meets(1, size_, {box.lower - margin, box.upper + margin});
  }

 private:
  void build(std::size_t node, std::span<Vec3> points) {
    Box& bounds = bounds_[node] = {points[0], points[0]};
    for (const Vec3& p : points) {
      bounds.lower = bounds.lower.cwiseMin(p);
      bounds.upper = bounds.upper.cwiseMax(p);
    }
    if (points.size() == 1) return;
    int longest = 0;
    bounds.size().maxCoeff(&longest);
    const std::size_t middle = points.size() / 2;
    std::ranges::nth_element(points, points.begin() + middle, {}, [longest](const Vec3& p) { return p[longest]; });
    build(2 * node, points.first(middle));
    build(2 * node + 1, points.subspan(middle));
  }

  /// A swept box meets a box if its swept lower corner meets that box grown by its size towards the lower side.
  bool meets(std::size_t node, std::size_t count, const Box& box) const {
    const Box& bounds = bounds_[node];
    if (!segment_meets({box.lower - bounds.size(), box.upper}, bounds.lower, sweep_)) return false;
    if (count == 1) return true;
    return meets(2 * node, count / 2, box) || meets(2 * node + 1, count - count / 2, box);
  }

  std::size_t size_;
  Vec3 sweep_;
  std::vector<Box> bounds_;
};

}  // namespace

RefinementCriterion refine_box(const Box& region, double coarsest, double spacing) {
  check_spacing(coarsest, spacing);
  return [=](const Box& box, int level) { return is_coarser(level, coarsest, spacing) && touches(region, box); };
}

RefinementCriterion refine_near(std::span<const Vec3> points, double distance, const Vec3& sweep, double coarsest,
                                double spacing) {
  check_spacing(coarsest, spacing);
  return [swept = SweptPoints(points, sweep), distance, coarsest, spacing](const Box& box, int level) {
    return is_coarser(level, coarsest, spacing) && swept.within(distance, box);
  };
}

RefinementCriterion any_of(std::vector<RefinementCriterion> criteria) {
  return [criteria = std::move(criteria)](const Box& box, int level) {
    return std::ranges::any_of(criteria, [&](const RefinementCriterion& criterion) { return criterion(box, level); });
  };
}

}  // namespace drogue::amr

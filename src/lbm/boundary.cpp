// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/boundary.hpp"

#include <cmath>
#include <numbers>

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

bool fixes_velocity(const fluid::Face& face) {
  return face.type == fluid::Boundary::velocity || face.type == fluid::Boundary::no_slip;
}

/// Is the velocity on this face given by a formula that differs from cell to cell or in time?
bool needs_table(const fluid::Face& face) {
  if (!fixes_velocity(face)) return false;
  for (const Expression& e : face.velocity)
    if (!e.is_constant()) return true;
  return false;
}

bool depends_on_time(const fluid::Face& face) {
  for (const Expression& e : face.velocity)
    if (e.depends_on_time()) return true;
  return false;
}

}  // namespace

template <class S>
BoundaryFill<S>::BoundaryFill(const amr::Forest& forest, const fluid::Specification& specification, const Units& units)
    : forest_(forest), specification_(specification), units_(units), items_(forest.levels()) {
  for (int level = 0; level < forest.levels(); ++level) {
    items_[level].resize(3);
    const Index3 across = forest.blocks_across(level);
    const auto range = forest.range(level, amr::Kind::boundary);
    for (int id = range.begin; id < range.end; ++id) {
      Index3 index = forest.block(id).index;
      int faces = 0;
      Item item{id, amr::none, 0, 0, -1, false};
      for (int a = 0; a < 3; ++a) {
        if (index[a] >= 0 && index[a] < across[a]) continue;
        item.beyond_wall |= faces > 0 && fixes_velocity(specification.face[item.face]);
        ++faces;
        item.axis = a;
        item.face = 2 * a + (index[a] >= across[a]);
      }
      index[item.axis] += item.face & 1 ? -1 : 1;
      item.source = forest.find(level, index);
      if (needs_table(specification.face[item.face])) {
        item.table = static_cast<int>(tables_.size());
        tables_.emplace_back(n);
        update_table(item, 0.0);
      }
      items_[level][faces - 1].push_back(item);
    }
  }
}

template <class S>
void BoundaryFill<S>::operator()(int level, double time, MomentField<S>& field) {
  using Layout = RowLayout<S>;
  for (const auto& items : items_[level]) {
    for (const Item& item : items)
      if (item.table >= 0 && depends_on_time(specification_.face[item.face])) update_table(item, time);
    const int count = static_cast<int>(items.size());
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
      const Item& item = items[i];
      const double rise = specification_.face[item.face].ramp;
      const double ramp = time < rise ? 0.5 * (1.0 - std::cos(std::numbers::pi * time / rise)) : 1.0;
      const std::byte* from = field.block(item.source);
      std::byte* to = field.block(item.target);
      const bool high = item.face & 1;
      const int inner = high ? n - 1 : 0, outer = high ? 0 : n - 1;
      for (int line = 0; line < n; ++line) {
        if (item.axis == 0) {
          const Row<Real> r = Layout::load_column(from, inner, line * n, 1);
          Layout::store_column(to, outer, line * n, 1, reflect(item, r, line, ramp));
        } else {
          const int inner_row = item.axis == 1 ? line * n + inner : inner * n + line;
          const int outer_row = item.axis == 1 ? line * n + outer : outer * n + line;
          const Row<Real> r = Layout::load_row(from + inner_row * Layout::bytes);
          Layout::store_row(to + outer_row * Layout::bytes, reflect(item, r, line, ramp));
        }
      }
    }
  }
}

template <class S>
auto BoundaryFill<S>::reflect(const Item& item, const Row<Real>& inside, int line, double ramp) const -> Row<Real> {
  const fluid::Face& face = specification_.face[item.face];
  Row<Real> r = inside;
  switch (face.type) {
    case fluid::Boundary::free_slip: {
      static constexpr std::array<std::array<Moment, 3>, 3> flipped{{{ux, pxy, pxz}, {uy, pxy, pyz}, {uz, pxz, pyz}}};
      for (const Moment m : flipped[item.axis]) r.m[m] = -r.m[m];
      break;
    }
    case fluid::Boundary::outlet:
      r.m[drho] = static_cast<Real>(2.0 * face.pressure / units_.pressure) - r.m[drho];
      break;
    case fluid::Boundary::velocity:
    case fluid::Boundary::no_slip:
      if (item.beyond_wall) break;
      for (int a = 0; a < 3; ++a) {
        const Vec<Real> wall =
            item.table >= 0 ? tables_[item.table][line][a]
                            : broadcast(static_cast<Real>(face.velocity[a](Vec3::Zero(), 0.0) / units_.velocity));
        r.m[ux + a] = static_cast<Real>(2.0 * ramp) * wall - r.m[ux + a];
      }
      break;
    case fluid::Boundary::periodic:
      break;
  }
  return r;
}

template <class S>
void BoundaryFill<S>::update_table(const Item& item, double time) {
  const fluid::Face& face = specification_.face[item.face];
  const Box& domain = forest_.domain().box;
  for (int line = 0; line < n; ++line)
    for (int lane = 0; lane < n; ++lane) {
      const Index3 cell = item.axis == 0   ? Index3{0, lane, line}
                          : item.axis == 1 ? Index3{lane, 0, line}
                                           : Index3{lane, line, 0};
      Vec3 position = forest_.cell_centre(item.target, cell);
      position[item.axis] = item.face & 1 ? domain.upper[item.axis] : domain.lower[item.axis];
      for (int a = 0; a < 3; ++a)
        tables_[item.table][line][a][lane] = static_cast<Real>(face.velocity[a](position, time) / units_.velocity);
    }
}

#ifdef __F16C__
template class BoundaryFill<HalfStress>;
#endif
template class BoundaryFill<FloatStress>;
template class BoundaryFill<DoubleStress>;

}  // namespace drogue::lbm

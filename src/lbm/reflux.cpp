// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/reflux.hpp"

#include <numeric>
#include <utility>

#include "lbm/d3q19.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

/// At its x faces the columns of a block are up to date, its rows need not be; beyond the domain there are rows only.
bool keeps_columns(const amr::Forest& forest, int block) { return forest.block(block).kind != amr::Kind::boundary; }

/// The layer of cells of a block at one of its faces, by rows and lanes.
template <class S>
class Layer {
 public:
  using Layout = RowLayout<S>;
  using Real = typename S::Real;

  Layer(const MomentField<S>& field, const amr::Forest& forest, int block, int face)
      : axis_(face / 2),
        depth_(face & 1 ? n - 1 : 0),
        rows_(field.block(block)),
        columns_(axis_ == 0 && keeps_columns(forest, block) ? field.column(block, depth_, 0) : nullptr) {}

  Vec<Real> row(int m, int r) const {
    if (axis_ == 1) return Layout::load(rows_ + (r * n + depth_) * Layout::bytes, m);
    if (axis_ == 2) return Layout::load(rows_ + (depth_ * n + r) * Layout::bytes, m);
    if (columns_) return Layout::load(columns_ + r * Layout::bytes, m);
    alignas(128) Real value[lanes];
    for (int lane = 0; lane < lanes; ++lane) value[lane] = cell(m, r, lane);
    return load(value);
  }

  Real cell(int m, int r, int lane) const {
    if (columns_) return Layout::get(columns_ + r * Layout::bytes, m, lane);
    const int x = axis_ == 0 ? depth_ : lane, y = axis_ == 0 ? lane : axis_ == 1 ? depth_ : r;
    return Layout::get(rows_ + ((axis_ == 2 ? depth_ : r) * n + y) * Layout::bytes, m, x);
  }

 private:
  const int axis_, depth_;
  const std::byte *rows_, *columns_;
};

constexpr Moment stress(int a, int b) {
  if (a == b) return static_cast<Moment>(pxx + a);
  return static_cast<Moment>(pxy + a + b - 1);
}

/// Pi_nt of the step, with `get(m)` a moment of the cells.
template <class T, class Get>
T shear(int normal, int tangent, Scalar<T> keep, Get get) {
  return (Scalar<T>(1) + get(drho)) * get(ux + normal) * get(ux + tangent) + keep * get(stress(normal, tangent));
}

/// Mass that leaves cells through the face on the side `sign` of `normal`.
template <class T, class Get>
T leaving(int normal, int sign, Scalar<T> keep, Get get) {
  using Real = Scalar<T>;
  const T rho = Real(1) + get(drho), u = get(ux + normal);
  return Real(0.5) * (get(drho) * (Real(1) / 3) + rho * u * u + keep * get(pxx + normal) + Real(sign) * rho * u);
}

}  // namespace

template <class S>
Reflux<S>::Reflux(const amr::Forest& forest, const fluid::Specification& specification, int coarse)
    : forest_(forest),
      third_order_(specification.collision != fluid::Collision::bgk),
      hosts_(plan_interface(forest, specification, coarse)) {
  for (const Host& host : hosts_) cells_ += static_cast<int>(host.faces.size()) * n * n;
}

/// Adds the mass that a step carries from the outer to the inner side.
template <class S>
void Reflux<S>::add_sheet(const MomentField<S>& field, const InterfaceFace& face, Real keep, Sheet& sheet) const {
  const int axis = face.face / 2, side = face.face & 1, sign = side ? 1 : -1;
  const int along = lane_axis(axis), across = row_axis(axis);
  const auto beside = [&](int block, int direction) {
    Index3 offset{0, 0, 0};
    offset[direction] = -1;
    return forest_.block(block).neighbour[amr::neighbour_slot(offset[0], offset[1], offset[2])];
  };
  const auto layers = [&](int inner, int outer) {
    return std::pair(Layer<S>(field, forest_, inner, face.face), Layer<S>(field, forest_, outer, face.face ^ 1));
  };
  const auto [inner, outer] = layers(face.inner, face.outer);
  const auto quarter_shear = [&](const auto& pair, int tangent, int r) {
    const auto of = [&](const Layer<S>& l) {
      return shear<Vec<Real>>(axis, tangent, keep, [&](int m) { return l.row(m, r); });
    };
    return Real(0.25 * sign) * (of(pair.first) + of(pair.second));
  };
  const auto quarter_shear_before = [&](const auto& pair, int r) {  // in the last lane of the blocks before
    const auto of = [&](const Layer<S>& l) {
      return shear<Real>(axis, along, keep, [&](int m) { return l.cell(m, r, lanes - 1); });
    };
    return Real(0.25 * sign) * (of(pair.first) + of(pair.second));
  };
  const std::pair here(inner, outer);
  const bool flat_lanes = face.end[0] == End::flat, flat_rows = face.end[2] == End::flat;
  const auto lanes_before = flat_lanes ? layers(beside(face.inner, along), beside(face.outer, along)) : here;
  const auto rows_before = flat_rows ? layers(beside(face.inner, across), beside(face.outer, across)) : here;

  Vec<Real> below = flat_rows ? quarter_shear(rows_before, across, n - 1) : Vec<Real>{};
  if (face.end[2] == End::open) below = quarter_shear(here, across, 0);
  for (int r = 0; r < n; ++r) {
    const auto of_inner = [&](int m) { return inner.row(m, r); };
    const auto of_outer = [&](int m) { return outer.row(m, r); };
    Vec<Real> sum = leaving<Vec<Real>>(axis, -sign, keep, of_outer) - leaving<Vec<Real>>(axis, sign, keep, of_inner);
    Vec<Real> up = quarter_shear(here, across, r);
    if (r == n - 1 && face.end[3] == End::closed) up = Vec<Real>{};
    sum += up - below;
    below = up;
    Vec<Real> right = quarter_shear(here, along, r);
    Real first = flat_lanes ? quarter_shear_before(lanes_before, r) : Real(0);
    if (face.end[0] == End::open) first = right[0];
    if (face.end[1] == End::closed) right[lanes - 1] = Real(0);
    sum += right - shift_up<Real>(right, first);
    sheet[r] += sum;
  }
}

template <class S>
auto Reflux<S>::entering(const MomentField<S>& field, const DiagonalTerm& term, int along, Real keep) const
    -> Vec<Real> {
  using Layout = RowLayout<S>;
  const auto [x, y, z] = term.first;
  const bool in_column = along != 0 && (x == 0 || x == n - 1) && keeps_columns(forest_, term.block);
  const Row<Real> cells = !in_column   ? Layout::load_line(field.block(term.block), term.first, along)
                          : along == 1 ? Layout::load_row(field.column(term.block, x, z))
                                       : Layout::load_column(field.column(term.block, x, 0), y, 0, 1);
  return static_cast<Real>(term.weight) * population_along(cells, keep, third_order_, term.direction);
}

/// Mass that a step carries inwards on the coarse or the fine side of a host, in rho of a cell of that side.
template <class S>
double Reflux<S>::carried(const MomentField<S>& field, const Host& host, bool fine, Real keep) const {
  Sheet sheet{};
  for (const Host::Face& face : host.faces) {
    if (!fine) add_sheet(field, face.coarse, keep, sheet);
    for (int quarter = 0; fine && quarter < 4; ++quarter) add_sheet(field, face.fine[quarter], keep, sheet);
  }
  for (const Host::Line& line : host.lines)
    for (const DiagonalTerm& term : fine ? line.fine : line.coarse) sheet[0] += entering(field, term, line.along, keep);
  double sum = 0.0;
  for (const Vec<Real>& row : sheet)
    for (int lane = 0; lane < lanes; ++lane) sum += row[lane];
  return sum;
}

/// Sum over the hosts, in their order whoever computes the terms.
template <class S>
template <class F>
double Reflux<S>::sum_over_hosts(const F& of_host) const {
  const int count = static_cast<int>(hosts_.size());
  std::vector<double> part(count);
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) part[i] = of_host(hosts_[i]);
  return std::accumulate(part.begin(), part.end(), 0.0);
}

template <class S>
void Reflux<S>::count_fine_step(const MomentField<S>& field, const Relaxation& relaxation) {
  const Real keep = static_cast<Real>(1.0 - 1.0 / relaxation.tau);
  constexpr double volume = 1.0 / 8.0;
  owed_ += volume * sum_over_hosts([&](const Host& host) { return carried(field, host, true, keep); });
}

template <class S>
void Reflux<S>::settle(const MomentField<S>& start, const Relaxation& relaxation, MomentField<S>& end) {
  const Real keep = static_cast<Real>(1.0 - 1.0 / relaxation.tau);
  owed_ -= sum_over_hosts([&](const Host& host) { return carried(start, host, false, keep); });
  if (cells_ == 0) return;
  const Real share = static_cast<Real>(owed_ / cells_);
  owed_ -= sum_over_hosts([&](const Host& host) {
    double given = 0.0;
    for (const Host::Face& face : host.faces)
      for (int r = 0; r < n; ++r)
        for (int lane = 0; lane < lanes; ++lane) {
          const int axis = face.coarse.face / 2;
          Index3 cell;
          cell[axis] = face.coarse.face & 1 ? n - 1 : 0;
          cell[row_axis(axis)] = r;
          cell[lane_axis(axis)] = lane;
          given += end.add(host.leaf, cell, drho, share);
        }
    return given;
  });
}

template <class S>
void Reflux<S>::transfer_state(Archive& archive) {
  archive.transfer("owed_mass", owed_);
}

#ifdef __F16C__
template class Reflux<HalfStress>;
#endif
template class Reflux<FloatStress>;
template class Reflux<DoubleStress>;

}  // namespace drogue::lbm

// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/reflux.hpp"

#include <numeric>
#include <utility>

#include "lbm/d3q19.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

/// The lines of cells of a block, no boundary block, at one of its faces: columns at x faces, rows at the others.
template <class S>
class Layer {
 public:
  using Layout = RowLayout<S>;

  Layer(const MomentField<S>& field, int block, int face) {
    const int axis = face / 2, depth = face & 1 ? n - 1 : 0;
    first_ = axis == 0   ? field.column(block, depth, 0)
             : axis == 1 ? field.row(block, depth, 0)
                         : field.row(block, 0, depth);
    stride_ = axis == 1 ? n * Layout::bytes : Layout::bytes;
  }

  auto line(int m, int r) const { return Layout::load(first_ + r * stride_, m); }

 private:
  const std::byte* first_;
  std::size_t stride_;
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

/// Mass that a step carries from the outer to the inner side of a face, lane by lane. Of the diagonal populations what
/// leaves a face along it enters the next one, except at an open boundary.
template <class S>
auto Reflux<S>::through(const MomentField<S>& field, const InterfaceFace& face, Real keep) const -> Vec<Real> {
  const int axis = face.face / 2, sign = face.face & 1 ? 1 : -1;
  const Layer<S> inner(field, face.inner, face.face), outer(field, face.outer, face.face ^ 1);
  const auto quarter_shear = [&](int tangent, int r) {
    const auto of = [&](const Layer<S>& l) {
      return shear<Vec<Real>>(axis, tangent, keep, [&](int m) { return l.line(m, r); });
    };
    return Real(0.25 * sign) * (of(inner) + of(outer));
  };
  Vec<Real> sum{};
  for (int r = 0; r < n; ++r) {
    sum += leaving<Vec<Real>>(axis, -sign, keep, [&](int m) { return outer.line(m, r); }) -
           leaving<Vec<Real>>(axis, sign, keep, [&](int m) { return inner.line(m, r); });
    if (!face.open[0] && !face.open[1]) continue;
    const Vec<Real> along = quarter_shear(lane_axis(axis), r);
    if (face.open[0]) sum[0] -= along[0];
    if (face.open[1]) sum[lanes - 1] += along[lanes - 1];
  }
  if (face.open[2]) sum -= quarter_shear(row_axis(axis), 0);
  if (face.open[3]) sum += quarter_shear(row_axis(axis), n - 1);
  return sum;
}

template <class S>
auto Reflux<S>::entering(const MomentField<S>& field, const DiagonalTerm& term, int along, Real keep) const
    -> Vec<Real> {
  using Layout = RowLayout<S>;
  const auto [x, y, z] = term.first;
  // at its x faces the columns of a block are up to date, its rows need not be; beyond the domain there are rows only
  const bool in_column = along != 0 && (x == 0 || x == n - 1) && forest_.block(term.block).kind != amr::Kind::boundary;
  const Row<Real> cells = !in_column   ? Layout::load_line(field.block(term.block), term.first, along)
                          : along == 1 ? Layout::load_row(field.column(term.block, x, z))
                                       : Layout::load_column(field.column(term.block, x, 0), y, 0, 1);
  return static_cast<Real>(term.weight) * population_along(cells, keep, third_order_, term.direction);
}

/// Mass that a step carries inwards on the coarse or the fine side of a host, in rho of a cell of that side.
template <class S>
double Reflux<S>::carried(const MomentField<S>& field, const Host& host, bool fine, Real keep) const {
  Vec<Real> mass{};
  for (const Host::Face& face : host.faces) {
    if (!fine) mass += through(field, face.coarse, keep);
    for (int quarter = 0; fine && quarter < 4; ++quarter) mass += through(field, face.fine[quarter], keep);
  }
  for (const Host::Line& line : host.lines)
    for (const DiagonalTerm& term : fine ? line.fine : line.coarse) mass += entering(field, term, line.along, keep);
  double sum = 0.0;
  for (int lane = 0; lane < lanes; ++lane) sum += mass[lane];
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

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

/// Sum of f(item), in their order whoever computes the terms.
template <class Items, class F>
double sum_over(const Items& items, const F& f) {
  const int count = static_cast<int>(items.size());
  std::vector<double> part(count);
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < count; ++i) part[i] = f(items[i]);
  return std::accumulate(part.begin(), part.end(), 0.0);
}

template <class V>
double sum_of_lanes(const V& v) {
  double sum = 0.0;
  for (int lane = 0; lane < lanes; ++lane) sum += v[lane];
  return sum;
}

}  // namespace

template <class S>
Reflux<S>::Reflux(const amr::Forest& forest, const fluid::Specification& specification, int coarse)
    : forest_(forest),
      third_order_(specification.collision != fluid::Collision::bgk),
      interface_(plan_interface(forest, specification, coarse)) {
  for (const Interface::Host& host : interface_.hosts) cells_ += static_cast<int>(host.size()) * n * n;
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
auto Reflux<S>::entering(const MomentField<S>& field, const DiagonalTerm& term, Real keep) const -> Vec<Real> {
  using Layout = RowLayout<S>;
  const auto [x, y, z] = term.first;
  // at its x faces the columns of a block are up to date, its rows need not be; beyond the domain there are rows only
  const bool in_column =
      term.along != 0 && (x == 0 || x == n - 1) && forest_.block(term.block).kind != amr::Kind::boundary;
  const Row<Real> cells = !in_column        ? Layout::load_line(field.block(term.block), term.first, term.along)
                          : term.along == 1 ? Layout::load_row(field.column(term.block, x, z))
                                            : Layout::load_column(field.column(term.block, x, 0), y, 0, 1);
  return static_cast<Real>(term.weight) * population_along(cells, keep, third_order_, term.direction);
}

template <class S>
double Reflux<S>::diagonally(const MomentField<S>& field, const std::vector<DiagonalTerm>& terms, Real keep) const {
  return sum_over(terms, [&](const DiagonalTerm& term) { return sum_of_lanes(entering(field, term, keep)); });
}

template <class S>
void Reflux<S>::count_fine_step(const MomentField<S>& field, const Relaxation& relaxation) {
  const Real keep = static_cast<Real>(1.0 - 1.0 / relaxation.tau);
  constexpr double volume = 1.0 / 8.0;
  owed_ += volume * sum_over(interface_.hosts, [&](const Interface::Host& host) {
             Vec<Real> mass{};
             for (const Interface::Face& face : host)
               for (const InterfaceFace& quarter : face.fine) mass += through(field, quarter, keep);
             return sum_of_lanes(mass);
           });
  owed_ += volume * diagonally(field, interface_.fine, keep);
}

template <class S>
void Reflux<S>::settle(const MomentField<S>& start, const Relaxation& relaxation, MomentField<S>& end) {
  const Real keep = static_cast<Real>(1.0 - 1.0 / relaxation.tau);
  owed_ -= sum_over(interface_.hosts, [&](const Interface::Host& host) {
    Vec<Real> mass{};
    for (const Interface::Face& face : host) mass += through(start, face.coarse, keep);
    return sum_of_lanes(mass);
  });
  owed_ -= diagonally(start, interface_.coarse, keep);
  if (cells_ == 0) return;
  const Real share = static_cast<Real>(owed_ / cells_);
  owed_ -= sum_over(interface_.hosts, [&](const Interface::Host& host) {
    double given = 0.0;
    for (const Interface::Face& face : host) given += give(face.coarse, share, end);
    return given;
  });
}

/// Adds the share to each cell of the coarse side of a face; returns what arrived.
template <class S>
double Reflux<S>::give(const InterfaceFace& face, Real share, MomentField<S>& field) const {
  const int axis = face.face / 2;
  double given = 0.0;
  for (int r = 0; r < n; ++r)
    for (int lane = 0; lane < lanes; ++lane) {
      Index3 cell;
      cell[axis] = face.face & 1 ? n - 1 : 0;
      cell[row_axis(axis)] = r;
      cell[lane_axis(axis)] = lane;
      given += field.add(face.inner, cell, drho, share);
    }
  return given;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/reflux.hpp"

#include <iterator>
#include <numeric>
#include <utility>

#include "lbm/d3q19.hpp"
#include "lbm/lines.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

/// The lines of cells of a block, no boundary block, at one of its faces.
template <class S>
struct Layer {
  const MomentField<S>& field;
  int block, face;

  auto line(int m, int r) const { return RowLayout<S>::load(field.line(block, face / 2, face & 1 ? n - 1 : 0, r), m); }
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
  const auto count = std::distance(items.begin(), items.end());
  std::vector<double> part(count);
#pragma omp parallel for schedule(dynamic, 16)
  for (std::ptrdiff_t i = 0; i < count; ++i) part[i] = f(items.begin()[i]);
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
Crossing<S>::Crossing(bool third_order, InterfaceSide side) : third_order_(third_order), side_(std::move(side)) {
  through_leaf_.resize(std::distance(side_.faces.begin(), side_.faces.end()));
}

/// Mass that a step carries from the outer to the inner side of a face, lane by lane. Of the diagonal populations what
/// leaves a face along it enters the next one, except at an open boundary.
template <class S>
auto Crossing<S>::through(const MomentField<S>& field, const InterfaceFace& face, Real keep) const -> Vec<Real> {
  const int axis = face.face / 2, sign = face.face & 1 ? 1 : -1;
  const Layer<S> inner{field, face.inner, face.face}, outer{field, face.outer, face.face ^ 1};
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
    const Vec<Real> along = quarter_shear(along_axis(axis), r);
    if (face.open[0]) sum[0] -= along[0];
    if (face.open[1]) sum[lanes - 1] += along[lanes - 1];
  }
  if (face.open[2]) sum -= quarter_shear(across_axis(axis), 0);
  if (face.open[3]) sum += quarter_shear(across_axis(axis), n - 1);
  return sum;
}

template <class S>
auto Crossing<S>::entering(const MomentField<S>& field, const DiagonalTerm& term, Real keep) const -> Vec<Real> {
  const Row<Real> cells = field.load_line(term.block, term.first, term.along, term.in_columns);
  return static_cast<Real>(term.weight) * population_along(cells, keep, third_order_, term.direction);
}

template <class S>
void Crossing<S>::count(int leaf, const MomentField<S>& field, const Relaxation& relaxation) {
  const Real keep = static_cast<Real>(1.0 - 1.0 / relaxation.tau);
  Vec<Real> mass{};
  for (const InterfaceFace& face : side_.faces[leaf]) mass += through(field, face, keep);
  for (const DiagonalTerm& term : side_.diagonals[leaf]) mass += entering(field, term, keep);
  through_leaf_[side_.faces.index(leaf)] = sum_of_lanes(mass);
}

template <class S>
double Crossing<S>::total() const {
  return std::accumulate(through_leaf_.begin(), through_leaf_.end(), 0.0);
}

template <class S>
Reflux<S>::Reflux(const amr::Forest& forest, const fluid::Specification& specification, int coarse)
    : Reflux(specification.collision != fluid::Collision::bgk, plan_interface(forest, specification, coarse)) {}

template <class S>
Reflux<S>::Reflux(bool third_order, Interface plan)
    : coarse_(third_order, std::move(plan.coarse)), fine_(third_order, std::move(plan.fine)) {
  for (const auto& faces : coarse_.faces()) cells_ += static_cast<int>(faces.size()) * n * n;
}

template <class S>
void Reflux<S>::end_coarse_step() {
  counted_ = -coarse_.total();
}

template <class S>
void Reflux<S>::end_fine_step() {
  constexpr double volume = 1.0 / 8.0;
  counted_ += volume * fine_.total();
}

template <class S>
void Reflux<S>::settle(MomentField<S>& field) {
  if (cells_ == 0) return;
  owed_ += std::exchange(counted_, 0.0);
  const auto share = static_cast<typename S::Real>(owed_ / cells_);
  owed_ -= sum_over(coarse_.faces(), [&](const std::vector<InterfaceFace>& of_leaf) {
    double given = 0.0;
    for (const InterfaceFace& face : of_leaf)
      for (int r = 0; r < n; ++r) given += field.add_at_face(face.inner, face.face, r, drho, share);
    return given;
  });
}

template <class S>
void Reflux<S>::transfer_state(Archive& archive) {
  archive.transfer("owed_mass", owed_);
  archive.transfer("counted_mass", counted_);
}

#ifdef __F16C__
template class Crossing<HalfStress>;
template class Reflux<HalfStress>;
#endif
template class Crossing<FloatStress>;
template class Crossing<DoubleStress>;
template class Reflux<FloatStress>;
template class Reflux<DoubleStress>;

}  // namespace drogue::lbm

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/flop_count.hpp"

#include <array>
#include <cmath>

#include "lbm/d3q19.hpp"
#include "lbm/eddy_viscosity.hpp"

namespace drogue::bench {

namespace {

/// A number that tells its counter of every operation it takes part in; constants have no counter.
struct Counted {
  double value = 0.0;
  int* count = nullptr;

  Counted() = default;
  explicit Counted(double constant, int* counter = nullptr) : value(constant), count(counter) {}
};

Counted combine(const Counted& a, const Counted& b, double value) {
  int* count = a.count ? a.count : b.count;
  if (count) ++*count;
  return Counted(value, count);
}
Counted operator+(const Counted& a, const Counted& b) { return combine(a, b, a.value + b.value); }
Counted operator-(const Counted& a, const Counted& b) { return combine(a, b, a.value - b.value); }
Counted operator*(const Counted& a, const Counted& b) { return combine(a, b, a.value * b.value); }
Counted operator/(const Counted& a, const Counted& b) { return combine(a, b, a.value / b.value); }
Counted operator/(const Counted& a, int b) { return a / Counted(b); }
Counted& operator+=(Counted& a, const Counted& b) { return a = a + b; }
Counted& operator-=(Counted& a, const Counted& b) { return a = a - b; }
Counted square_root(const Counted& a) { return combine(a, a, std::sqrt(a.value)); }
Counted rough_square_root(const Counted& a) { return square_root(a); }
Counted rough_reciprocal(const Counted& a) { return Counted(1.0) / a; }
Counted maximum(const Counted& a, const Counted& b) { return combine(a, b, std::fmax(a.value, b.value)); }

/// Populations of a cell, from which its own moments are taken again.
template <class Series>
struct Populations {
  const Series& series;
  template <int cx, int cy, int cz>
  Counted get() const {
    return series.template population<cx, cy, cz>();
  }
};

template <bool third_order>
void rebuild_and_collect(int& count) {
  std::array<Counted, lbm::moments> m;
  for (Counted& value : m) value = Counted(0.01, &count);
  const lbm::HermiteSeries<Counted, third_order> series(m, Counted(-0.9));
  lbm::moments_of<Counted>(Populations<lbm::HermiteSeries<Counted, third_order>>{series});
}

void evaluate_eddy_viscosity(fluid::EddyViscosity eddy, int& count) {
  lbm::Gradient<Counted> g;
  for (auto& along : g) {
    for (Counted& value : along) value = Counted(0.01, &count);
  }
  using fluid::EddyViscosity;
  if (eddy == EddyViscosity::vreman) lbm::eddy_viscosity<EddyViscosity::vreman>(g, Counted(0.07));
  if (eddy == EddyViscosity::wale) lbm::eddy_viscosity<EddyViscosity::wale>(g, Counted(0.25));
  if (eddy == EddyViscosity::smagorinsky) lbm::eddy_viscosity<EddyViscosity::smagorinsky>(g, Counted(0.03));
}

// What BlockKernel computes itself, on vectors only: the differences and the blend of six stresses, with what cancels
// dispersion; a relaxation time with eddy viscosity; the watch over speed and density.
constexpr int of_hybrid_term = 9 + 3 * 3 + 3 * 4 + 3 + 3 * 8, of_local_tau = 9, of_watch = 9;

}  // namespace

int flops_per_update(fluid::Collision collision, fluid::EddyViscosity eddy) {
  int count = of_watch;
  if (collision == fluid::Collision::bgk) {
    rebuild_and_collect<false>(count);
  } else {
    rebuild_and_collect<true>(count);
  }
  if (collision == fluid::Collision::hrr) count += of_hybrid_term;
  if (eddy != fluid::EddyViscosity::none) {
    count += of_local_tau;
    evaluate_eddy_viscosity(eddy, count);
  }
  return count;
}

}  // namespace drogue::bench

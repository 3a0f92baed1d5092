// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/machine.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>

#include "app/inspect.hpp"
#include "app/version.hpp"
#include "core/huge_array.hpp"
#include "core/stopwatch.hpp"
#include "lbm/simd.hpp"

namespace drogue::bench {

namespace {

using lbm::lanes;
using Vector = lbm::Vec<float>;
constexpr int repetitions = 3;

/// As many as hide the latency of a fused multiply-add on two ports.
constexpr int chains = 12;

/// All chains `rounds` times; what comes out depends on all, so that none can be left out.
float multiply_and_add(int rounds) {
  std::array<Vector, chains> value;
  for (int c = 0; c < chains; ++c) value[c] = lbm::broadcast(1.0f + static_cast<float>(c));
  const Vector factor = lbm::broadcast(0.999999f), term = lbm::broadcast(1e-6f);
  for (int round = 0; round < rounds; ++round) {
    for (int c = 0; c < chains; ++c) value[c] = value[c] * factor + term;
  }
  Vector sum{};
  for (const Vector& v : value) sum += v;
  return sum[0];
}

}  // namespace

std::string describe_machine() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{}, {} threads; {} {}, `{}`; Drogue {}; {:%Y-%m-%d}", app::processor_name(),
                     omp_get_max_threads(), DROGUE_COMPILER, __VERSION__, DROGUE_FLAGS, app::version,
                     fmt::localtime(now));
}

double copy_bandwidth(int threads) {
  constexpr std::ptrdiff_t bytes = std::ptrdiff_t{384} << 20, count = bytes / sizeof(float);
  HugeArray from_bytes(bytes), to_bytes(bytes);
  auto* from = reinterpret_cast<float*>(from_bytes.data());
  auto* to = reinterpret_cast<float*>(to_bytes.data());
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::ptrdiff_t i = 0; i < count; i += lanes) lbm::store(from + i, lbm::broadcast(1.0f));
  double best = 0.0;
  for (int repetition = 0; repetition <= repetitions; ++repetition) {  // the first one touches the pages
    const Elapsed elapsed;
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::ptrdiff_t i = 0; i < count; i += lanes) lbm::store_streaming(to + i, lbm::load(from + i));
    if (repetition > 0) best = std::max(best, 2e-9 * bytes / elapsed.seconds());
  }
  return best;
}

double arithmetic_peak(int threads) {
  constexpr int rounds = 10'000'000;
  double best = 0.0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    float sum = 0.0f;
    const Elapsed elapsed;
#pragma omp parallel num_threads(threads) reduction(+ : sum)
    sum += multiply_and_add(rounds);
    const double seconds = elapsed.seconds();
    if (sum != 0.0f) best = std::max(best, 2e-9 * rounds * chains * lanes * threads / seconds);
  }
  return best;
}

}  // namespace drogue::bench

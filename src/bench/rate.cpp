// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/rate.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdint>

#include "core/stopwatch.hpp"

namespace drogue::bench {

namespace {

/// Steps for so long, at least once.
double million_updates_per_second(const Subject& subject, double seconds) {
  const std::int64_t before = subject.fluid.statistics().cell_updates;
  const Elapsed elapsed;
  do subject.fluid.step(subject.hook);
  while (elapsed.seconds() < seconds);
  return 1e-6 * static_cast<double>(subject.fluid.statistics().cell_updates - before) / elapsed.seconds();
}

Rate rate_of(std::vector<double> values) {
  std::ranges::sort(values);
  const double median = values[values.size() / 2];
  return {values.back(), median, (values.back() - values.front()) / median};
}

}  // namespace

std::vector<Rate> measure_rates(const std::vector<Subject>& subjects, const Patience& patience) {
  std::vector<std::vector<double>> values(subjects.size());
  for (const Subject& subject : subjects) million_updates_per_second(subject, 0.2 * patience.seconds);
  for (int repetition = 0; repetition < patience.repetitions; ++repetition) {
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      values[i].push_back(million_updates_per_second(subjects[i], patience.seconds));
    }
  }
  std::vector<Rate> rates;
  for (const auto& of_subject : values) rates.push_back(rate_of(of_subject));
  return rates;
}

std::vector<int> thread_counts() {
  const int most = omp_get_max_threads();
  std::vector<int> counts;
  for (int threads = 1; threads < most; threads *= 2) counts.push_back(threads);
  counts.push_back(most);
  return counts;
}

}  // namespace drogue::bench

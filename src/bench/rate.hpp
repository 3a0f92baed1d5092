// SPDX-License-Identifier: GPL-3.0-or-later
// Cell updates a second of a fluid.
#pragma once

#include <functional>
#include <vector>

#include "fluid/fluid_solver.hpp"

namespace drogue::bench {

/// Million updates a second over several repetitions.
struct Rate {
  double best = 0.0, median = 0.0;
  double noise = 0.0;  ///< largest less smallest, over the median
};

/// How long is measured.
struct Patience {
  int repetitions = 5;
  double seconds = 0.3;  ///< of each, at least
};

/// A fluid, and what acts on it in each step.
struct Subject {
  fluid::FluidSolver& fluid;
  fluid::FineStepHook* hook = nullptr;
};

/// Steps the subjects in turn, so that a disturbance of the machine meets all; the first steps are not counted.
std::vector<Rate> measure_rates(const std::vector<Subject>& subjects, const Patience& patience);

/// 1, 2, 4 and so on up to the threads that OpenMP has, and these.
std::vector<int> thread_counts();

}  // namespace drogue::bench

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/kernel_costs.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "bench/test_flows.hpp"

namespace drogue::bench {

namespace {

/// A small force, as of a sheet, on four cells of every row of the first `share` of the finest leaves.
class SteadyForce : public fluid::FineStepHook {
 public:
  SteadyForce(const amr::Forest& forest, double share) {
    const auto leaves = forest.range(forest.finest(), amr::Kind::leaf);
    blocks_.resize(static_cast<std::size_t>(share * leaves.size()));
    std::iota(blocks_.begin(), blocks_.end(), leaves.begin);
  }
  void on_fine_step(fluid::FineStep& step) override {
    step.f.open(blocks_);
#pragma omp parallel for schedule(static)
    for (const int id : blocks_) {
      float* row = step.f.block(id);
      for (int i = 0; i < amr::block_size * amr::block_size; ++i, row += fluid::ForceField::stride_y)
        std::fill_n(row + amr::block_size / 2, 4, 1e-9f);
    }
  }

 private:
  std::vector<int> blocks_;
};

/// Share of the updates that are in leaves next to another level.
double share_at_interfaces(const amr::Forest& forest) {
  double all = 0.0, at_interface = 0.0;
  for (int level = 0; level < forest.levels(); ++level) {
    const auto leaves = forest.range(level, amr::Kind::leaf);
    for (int id = leaves.begin; id < leaves.end; ++id) {
      const double updates = 1 << level;
      all += updates;
      for (const int neighbour : forest.block(id).neighbour) {
        const amr::Kind kind = forest.block(neighbour).kind;
        if (kind != amr::Kind::ghost && kind != amr::Kind::parent) continue;
        at_interface += updates;
        break;
      }
    }
  }
  return at_interface / all;
}

/// A row for each number of threads.
void measure_cost(const std::string& feature, double share, const Subject& plain, const Subject& with,
                  const Patience& patience, ResultTable& table) {
  for (const int threads : thread_counts()) {
    omp_set_num_threads(threads);
    const std::vector<Rate> rates = measure_rates({plain, with}, patience);
    const double ratio = rates[1].best / rates[0].best;
    table.append({feature, std::to_string(threads), fmt::format("{:.3f}", share), fmt::format("{:.3f}", ratio),
                  fmt::format("{:.3f}", (1.0 / ratio - 1.0) / share)});
    fmt::print("{}\n", fmt::join(table.rows().back(), " "));
    std::fflush(stdout);
  }
}

std::string levels_name(int levels) { return fmt::format("{} levels", levels); }

constexpr int most_levels = 5;

}  // namespace

void measure_costs(bool quick, const Patience& patience, ResultTable& table) {
  const int across = quick ? 64 : 128;
  const auto plain = uniform_flow(across, default_operator());
  for (const Operator& op : operators()) {
    if (op.eddy == fluid::EddyViscosity::none) continue;
    measure_cost(op.name, 1.0, {*plain}, {*uniform_flow(across, op)}, patience, table);
  }
  for (const double share : {0.125, 1.0}) {
    const auto forced = uniform_flow(across, default_operator());
    SteadyForce force(forced->forest(), share);
    measure_cost("force", share, {*plain}, {*forced, &force}, patience, table);
  }
  for (int levels = 2; levels <= (quick ? 2 : most_levels); ++levels) {
    const auto nested = nested_flow(across, levels);
    measure_cost(levels_name(levels), share_at_interfaces(nested->forest()), {*plain}, {*nested}, patience, table);
  }
  if (quick) return;
  // interfaces grow as the square of the cubes' edge, and what they enclose as its third power
  for (const int edge : {64, 192}) {
    const auto uniform = uniform_flow(edge, default_operator()), nested = nested_flow(edge, most_levels);
    measure_cost(fmt::format("{} of {}^3", levels_name(most_levels), edge), share_at_interfaces(nested->forest()),
                 {*uniform}, {*nested}, patience, table);
  }
}

io::Plot plot_of_levels(const ResultTable& costs) {
  io::Plot plot{
      "nested cubes", {"levels", io::Scale::whole, 1.0}, {"rate over the uniform rate", io::Scale::linear, 0.0, 1.1}};
  for (const int threads : thread_counts()) {
    io::Curve curve{
        fmt::format("{} thread{}", threads, threads > 1 ? "s" : ""), {1.0}, {1.0}, io::Style::line_and_points};
    for (int levels = 2; levels <= most_levels; ++levels) {
      for (const Row& row : costs.rows()) {
        if (costs.text(row, "feature") != levels_name(levels) || costs.value(row, "threads") != threads) continue;
        curve.x.push_back(levels);
        curve.y.push_back(*costs.value(row, "rate_over_plain"));
      }
    }
    plot.curves.push_back(curve);
  }
  return plot;
}

}  // namespace drogue::bench

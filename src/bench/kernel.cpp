// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/kernel.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/flop_count.hpp"
#include "bench/kernel_costs.hpp"
#include "bench/machine.hpp"
#include "bench/rate.hpp"
#include "bench/result_table.hpp"
#include "bench/test_flows.hpp"
#include "lbm/solver.hpp"

namespace drogue::bench {

namespace {

using fluid::Collision, fluid::EddyViscosity, fluid::Storage;

const std::vector<std::pair<const char*, Storage>> storages{
    {"half_stress", Storage::half_stress}, {"float32", Storage::float32}, {"float64", Storage::float64}};

/// What this machine can do at best with so many threads.
struct Floor {
  double copy, arithmetic;  // [GB/s], [Gflop/s] in single precision
};
using Floors = std::map<int, Floor>;

/// Bytes that an update reads and writes by the layout: the cell's moments and, shared by the cells of a block, the
/// columns at its x faces, written and those of both neighbours read, and the rows of the neighbours along y and z.
/// What of the latter is still in a cache does not come from memory.
template <class S>
double bytes_moved() {
  using Layout = lbm::RowLayout<S>;
  constexpr double rows = 2 * lbm::rows_per_block, columns = 2 * lbm::MomentField<S>::column_bytes;
  constexpr double halo_rows = 4 * amr::block_size + 4;
  return ((rows + halo_rows) * Layout::bytes + columns) / amr::block_cells;
}

double bytes_per_update(Storage storage) {
  switch (storage) {
    case Storage::half_stress:
      return bytes_moved<lbm::DefaultStress>();
    case Storage::float32:
      return bytes_moved<lbm::FloatStress>();
    case Storage::float64:
      return bytes_moved<lbm::DoubleStress>();
  }
  return 0.0;
}

Floors measure_floors(const Options& options) {
  Floors floors;
  ResultTable table(options.folder / "kernel_floors.csv", {"threads", "copy_gb_s", "fma_gflop_s"}, ResultTable::anew);
  for (const int threads : thread_counts()) {
    const Floor floor{copy_bandwidth(threads), arithmetic_peak(threads)};
    floors[threads] = floor;
    table.append({std::to_string(threads), number(floor.copy), number(floor.arithmetic)});
  }
  return floors;
}

struct Variant {
  const Operator& op;
  std::pair<const char*, Storage> storage;
  int across;
  bool in_cache;
};

void measure_variant(const Variant& v, const Floors& floors, const Patience& patience, ResultTable& table) {
  const auto solver = uniform_flow(v.across, v.op, v.storage.second);
  const double bytes = bytes_per_update(v.storage.second), flops = flops_per_update(v.op.collision, v.op.eddy);
  const double lanes_lost = v.storage.second == Storage::float64 ? 2.0 : 1.0;
  for (const int threads : thread_counts()) {
    omp_set_num_threads(threads);
    const Rate rate = measure_rates({{*solver}}, patience).front();
    const Floor& floor = floors.at(threads);
    table.append({v.op.name, v.storage.first, std::to_string(threads), fmt::format("{}^3", v.across),
                  v.in_cache ? "cache" : "memory", std::to_string(amr::block_size), fmt::format("{:.1f}", rate.best),
                  fmt::format("{:.1f}", rate.median), fmt::format("{:.3f}", rate.noise), fmt::format("{:.1f}", bytes),
                  v.in_cache ? "" : fmt::format("{:.3f}", 1e-3 * rate.best * bytes / floor.copy),
                  fmt::format("{:.0f}", flops),
                  fmt::format("{:.3f}", 1e-3 * rate.best * flops * lanes_lost / floor.arithmetic)});
    fmt::print("{}\n", fmt::join(table.rows().back(), " "));
    std::fflush(stdout);
  }
}

/// Rows of one variant, by threads.
std::vector<Row> rows_of(const ResultTable& table, const std::string& op, const std::string& storage,
                         const std::string& where) {
  std::vector<Row> rows;
  for (const Row& row : table.rows()) {
    if (table.text(row, "operator") != op || table.text(row, "storage") != storage) continue;
    if (table.text(row, "where") == where) rows.push_back(row);
  }
  return rows;
}

/// A line for each operator and storage: rates by threads, and what the largest number of them makes of the floors.
std::string summary_of(const ResultTable& table) {
  Row header{"operator", "storage"};
  for (const char* where : {"memory", "cache"}) {
    for (const int threads : thread_counts()) header.push_back(fmt::format("{}, {}", where, threads));
  }
  header.insert(header.end(), {"bytes", "of bandwidth", "flops", "of arithmetic, in cache"});
  std::vector<Row> lines;
  for (const auto& [storage, kind] : storages) {
    for (const Operator& op : operators()) {
      Row line{op.name, storage};
      const auto memory = rows_of(table, op.name, storage, "memory"), cache = rows_of(table, op.name, storage, "cache");
      if (memory.empty()) continue;
      for (const auto& rows : {memory, cache}) {
        for (const Row& row : rows) line.push_back(fmt::format("{:.0f}", *table.value(row, "mlups")));
      }
      const auto percent = [&](const Row& row, const char* column) {
        return fmt::format("{:.0f} %", 100.0 * *table.value(row, column));
      };
      line.insert(line.end(),
                  {table.text(memory.back(), "bytes_per_update"), percent(memory.back(), "share_of_bandwidth"),
                   table.text(memory.back(), "flops_per_update"), percent(cache.back(), "share_of_arithmetic")});
      lines.push_back(line);
    }
  }
  return markdown(header, lines);
}

/// A curve over threads of the rows that the given cells name.
io::Curve curve_of(const ResultTable& table, const std::string& op, const std::string& storage,
                   const std::string& where, const std::string& label) {
  io::Curve curve{label, {}, {}, io::Style::line_and_points};
  for (const Row& row : rows_of(table, op, storage, where)) {
    curve.x.push_back(*table.value(row, "threads"));
    curve.y.push_back(*table.value(row, "mlups"));
  }
  return curve;
}

/// What `floor` of each number of threads would allow.
io::Curve bound_of(const Floors& floors, const std::string& label, double Floor::*floor, double per_update,
                   int colour) {
  io::Curve curve{label, {}, {}, io::Style::dashed, {}, colour};
  for (const auto& [threads, best] : floors) {
    curve.x.push_back(threads);
    curve.y.push_back(1e3 * best.*floor / per_update);
  }
  return curve;
}

io::Figure figure_of(const ResultTable& table, const Floors& floors, const io::Plot& levels) {
  const io::Axis threads{"threads", floors.size() > 3 ? io::Scale::logarithmic : io::Scale::whole};
  const io::Axis rate{"million cell updates/s", io::Scale::linear, 0.0};
  io::Plot memory{"from memory, 16-bit stresses", threads, rate, {}},
      cache{"in cache, 16-bit stresses", threads, rate, {}};
  for (const Operator& op : operators()) {
    memory.curves.push_back(curve_of(table, op.name, "half_stress", "memory", io::plain(op.name)));
    cache.curves.push_back(curve_of(table, op.name, "half_stress", "cache", io::plain(op.name)));
  }
  constexpr int grey = 7;
  memory.curves.push_back(
      bound_of(floors, "memory bandwidth", &Floor::copy, bytes_per_update(Storage::half_stress), grey));
  cache.curves.push_back(bound_of(floors, "arithmetic of hrr", &Floor::arithmetic,
                                  flops_per_update(Collision::hrr, EddyViscosity::none), grey));
  io::Plot storage{"hrr from memory, by storage", threads, rate, {}};
  for (const auto& [name, kind] : storages) {
    const int colour = static_cast<int>(storage.curves.size()) / 2;
    storage.curves.push_back(curve_of(table, "hrr", name, "memory", io::plain(name)));
    storage.curves.back().colour = colour;
    storage.curves.push_back(bound_of(floors, "its bandwidth", &Floor::copy, bytes_per_update(kind), colour));
  }
  return {"Speed of the fluid", {memory, cache, storage, levels}, 2};
}

}  // namespace

Report measure_kernel(const Options& options) {
  const int most_threads = omp_get_max_threads();
  const Patience patience = options.quick ? Patience{2, 0.01} : Patience{};
  const int in_cache = options.quick ? 32 : 48, in_memory = options.quick ? 64 : 224;

  const Floors floors = measure_floors(options);
  ResultTable table(options.folder / "kernel.csv",
                    {"operator", "storage", "threads", "cells", "where", "block_edge", "mlups", "mlups_median", "noise",
                     "bytes_per_update", "share_of_bandwidth", "flops_per_update", "share_of_arithmetic"},
                    ResultTable::anew);
  for (const auto& storage : storages) {
    for (const Operator& op : options.quick ? std::span(&default_operator(), 1) : operators()) {
      measure_variant({op, storage, in_memory, false}, floors, patience, table);
      measure_variant({op, storage, in_cache, true}, floors, patience, table);
    }
  }
  ResultTable costs(options.folder / "kernel_costs.csv",
                    {"feature", "threads", "share_of_updates", "rate_over_plain", "cost_of_its_blocks"},
                    ResultTable::anew);
  measure_costs(options.quick, patience, costs);
  omp_set_num_threads(most_threads);

  Report report;
  report.draw(figure_of(table, floors, plot_of_levels(costs)), options.folder / "kernel.png");
  report.text = "Floors: ";
  for (const auto& [threads, floor] : floors) {
    report.text += fmt::format("{} thread{}: {:.1f} GB/s copied, {:.0f} Gflop/s. ", threads, threads > 1 ? "s" : "",
                               floor.copy, floor.arithmetic);
  }
  report.text += "\n\nMillion updates/s, best of the repetitions, by threads:\n\n" + summary_of(table) + "\n" +
                 markdown(costs.columns(), costs.rows());
  return report;
}

}  // namespace drogue::bench

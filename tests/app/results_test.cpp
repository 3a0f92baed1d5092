// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/results.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "app/schedule.hpp"
#include "app/summary.hpp"

namespace drogue::app {
namespace {

/// Rows of a body at the end of each of `n` equal steps to `end`; C_D is a formula at the middle of each step.
template <class F>
Trace trace_of(int n, double end, F c_d, const std::string& body = "sheet") {
  Trace trace;
  for (int i = 1; i <= n; ++i) {
    const double dt = end / n;
    const auto put = [&](const std::string& name, double value) { trace.column[name].push_back(value); };
    trace.time.push_back(i * dt);
    const double value = c_d((i - 0.5) * dt);
    put(body + ".c_d", value);
    put(body + ".centre_dx", 0.1 * value);
    put(body + ".slip_normal", 0.0);
    put(body + ".face_difference", i == n / 2 ? 3.0 : 1.0);
    put(body + ".slip_rms", 0.01);
    put(body + ".wake_length", i / 10.0);
    put("mass_drift", 1e-6 * i);
  }
  return trace;
}

const Body sheet{"sheet", 1.0, ElasticBody{}};

Body rigid(const std::string& translation_x) {
  RigidBody body;
  body.shape = geometry::sphere(Vec3::Zero(), 1.0);
  body.motion.translation[0] = Expression(translation_x);
  return {"sphere", 1.0, body};
}

Case case_of(const Body& body, const std::array<double, 2>& stable_window = {2.0, 4.0}) {
  Case c{};
  c.bodies = {body};
  c.results = {.body = body.name, .stable_window = stable_window};
  return c;
}

std::optional<double> value_of(const std::vector<Result>& results, const std::string& name) {
  return std::ranges::find(results, name, &Result::name)->value;
}

TEST(Results, mean_of_a_constant_is_the_constant) {
  const Trace trace = trace_of(37, 8.0, [](double) { return 1.18; });
  EXPECT_NEAR(*window_mean(trace.time, trace.column.at("sheet.c_d"), {4.0, 8.0}), 1.18, 1e-14);
  EXPECT_NEAR(*window_drift(trace.time, trace.column.at("sheet.c_d"), {4.0, 8.0}), 0.0, 1e-14);
}

TEST(Results, mean_of_a_line_is_its_middle_even_where_rows_straddle_the_window) {
  // Step means of a line are its values at the middle of the steps, so only straddling rows can err: they count with
  // the part of their time inside the window, and are at most one step of 0.1 s away from it.
  const Trace exact = trace_of(80, 8.0, [](double t) { return t; });
  EXPECT_NEAR(*window_mean(exact.time, exact.column.at("sheet.c_d"), {4.0, 8.0}), 6.0, 1e-12);
  EXPECT_NEAR(*window_mean(exact.time, exact.column.at("sheet.c_d"), {4.03, 7.97}), 6.0, 0.1 * 0.1 / 3.9);
}

TEST(Results, drift_is_the_difference_of_the_halves_over_the_mean) {
  const Trace trace = trace_of(80, 8.0, [](double t) { return 1.0 + 0.01 * (t - 6.0); });
  EXPECT_NEAR(*window_drift(trace.time, trace.column.at("sheet.c_d"), {4.0, 8.0}), 0.02, 1e-12);
}

TEST(Results, uneven_rows_count_with_their_time) {
  const std::vector<double> time{1.0, 3.0, 4.0}, value{5.0, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(*window_mean(time, value, {0.0, 4.0}), (5.0 + 2.0 * 1.0 + 2.0) / 4.0);
  EXPECT_DOUBLE_EQ(*window_mean(time, value, {2.0, 4.0}), 1.5);
}

TEST(Results, a_window_that_was_not_reached_has_no_mean) {
  const Trace trace = trace_of(10, 5.0, [](double) { return 1.0; });
  EXPECT_FALSE(window_mean(trace.time, trace.column.at("sheet.c_d"), {4.0, 8.0}));
  EXPECT_FALSE(window_drift(trace.time, trace.column.at("sheet.c_d"), {4.0, 8.0}));
  EXPECT_FALSE(window_mean({}, {}, {4.0, 8.0}));
}

TEST(Results, peaks_before_their_time_do_not_count) {
  const Trace trace = trace_of(80, 8.0, [](double t) { return t < 0.1 ? 100.0 : 4.0 - (t - 0.65) * (t - 0.65); });
  Case c = case_of(sheet);
  EXPECT_EQ(value_of(summarise(trace, c), "cd_peak"), 100.0);
  c.results.peak_from = 0.15;
  const auto results = summarise(trace, c);
  EXPECT_DOUBLE_EQ(*value_of(results, "cd_peak"), 4.0);
  EXPECT_DOUBLE_EQ(*value_of(results, "cd_peak_time"), 0.7) << "the end of the row";
  EXPECT_DOUBLE_EQ(*value_of(results, "centre_dx_peak"), 0.4);
  EXPECT_EQ(value_of(results, "face_difference_max"), 3.0);
}

TEST(Results, a_body_has_those_that_mean_something_for_it) {
  const auto has = [](const Body& body, const std::string& name) {
    return std::ranges::count(result_names(case_of(body)), name) == 1;
  };
  for (const char* name : {"cd_peak", "cd_stable"}) {
    EXPECT_TRUE(has(sheet, name) && has(rigid("0"), name) && has(rigid("t"), name)) << name;
  }
  EXPECT_TRUE(has(sheet, "centre_dx_peak") && !has(rigid("0"), "centre_dx_peak"));
  EXPECT_TRUE(has(rigid("t"), "slip_rms_stable") && !has(sheet, "slip_rms_stable"));
  EXPECT_TRUE(has(rigid("0"), "wake_length")) << "it stands still";
  EXPECT_FALSE(has(rigid("t"), "wake_length") || has(sheet, "wake_length"));
}

TEST(Results, an_oscillation_is_measured_within_the_window) {
  ElasticBody flag;
  flag.probes = {{.name = "amplitude", .statistic = "peak_to_peak"}, {.name = "frequency", .statistic = "strouhal"}};
  Case c = case_of({"flag", 1.0, flag}, {4.0, 12.0});
  c.reference_length = 0.5;
  c.fluid.reference_velocity = 2.0;
  // 0.8 Hz with a harmonic, about a mean; larger and slower before the window.
  Trace trace = trace_of(
      1200, 12.0, [](double t) { return t; }, "flag");
  for (const double t : trace.time) {
    const double phase = 2.0 * std::numbers::pi * 0.8 * t;
    const double value = t < 4.0 ? 5.0 * std::sin(t) : 0.1 + 0.3 * std::sin(phase) + 0.02 * std::sin(3.0 * phase);
    trace.column["flag.amplitude"].push_back(value);
    trace.column["flag.frequency"].push_back(value);
  }
  const auto results = summarise(trace, c);
  EXPECT_NEAR(*value_of(results, "amplitude"), 0.56, 1e-3);
  EXPECT_NEAR(*value_of(results, "frequency"), 0.8 * 0.5 / 2.0, 1e-4);
}

TEST(Results, the_length_of_the_wake_is_that_at_the_end) {
  const Trace trace = trace_of(
      20, 4.0, [](double) { return 1.0; }, "sphere");
  EXPECT_EQ(value_of(summarise(trace, case_of(rigid("0"))), "wake_length"), 2.0);
}

TEST(Results, a_case_without_bodies_has_those_of_the_flow) {
  const Trace trace = trace_of(20, 4.0, [](double) { return 1.0; });
  Case c{};
  EXPECT_DOUBLE_EQ(*value_of(summarise(trace, c), "mass_drift"), 20e-6);
  EXPECT_EQ(std::ranges::count(result_names(c), "cd_peak"), 0);
}

TEST(Results, the_peak_of_the_dissipation_is_the_top_of_a_parabola_in_units_of_the_flow) {
  Case c{};
  c.measure.energy = true;
  c.fluid.reference_velocity = 2.0;
  c.reference_length = 3.0;
  Trace trace;
  for (int i = 1; i <= 40; ++i) {
    const double dt = 0.1, middle = (i - 0.5) * dt;
    trace.time.push_back(i * dt);
    trace.column["mass_drift"].push_back(0.0);
    trace.column["dissipation"].push_back(5.0 - (middle - 2.03) * (middle - 2.03));
  }
  const auto results = summarise(trace, c);
  EXPECT_NEAR(*value_of(results, "dissipation_peak"), 5.0 * 3.0 / 8.0, 1e-12);
  EXPECT_NEAR(*value_of(results, "dissipation_peak_time"), 2.03 * 2.0 / 3.0, 1e-12);
  c.results.peak_from = 2.6;
  EXPECT_FALSE(value_of(summarise(trace, c), "dissipation_peak")) << "it only falls after that";
}

TEST(Results, references_agree_within_their_relative_bound) {
  const std::vector<Result> results{{"cd_stable", "", 1.29}, {"cd_peak", "", std::nullopt}};
  const std::vector<Reference> references{
      {"cd_stable", 1.18, 0.10, "a"}, {"cd_stable", 1.18, 0.09, "b"}, {"cd_peak", 4.2, 0.1, "c"}};
  const auto comparisons = compare(results, references);
  EXPECT_NEAR(comparisons[0].difference, 0.11 / 1.18, 1e-12);
  EXPECT_TRUE(comparisons[0].agrees);
  EXPECT_FALSE(comparisons[1].agrees);
  EXPECT_FALSE(comparisons[2].value);
  EXPECT_FALSE(comparisons[2].agrees);
}

TEST(Results, a_bound_is_kept_by_small_values_of_either_sign) {
  const std::vector<Result> results{{"up", "", 2e-3}, {"down", "", -2e-3}};
  const auto comparisons = compare(results, {{"up", 0.0, 3e-3, ""}, {"down", 0.0, 3e-3, ""}, {"down", 0.0, 1e-3, ""}});
  EXPECT_TRUE(comparisons[0].agrees);
  EXPECT_TRUE(comparisons[1].agrees);
  EXPECT_FALSE(comparisons[2].agrees);
}

TEST(Summary, holds_what_tools_read) {
  Summary summary;
  summary.case_name = "plate";
  summary.fluid = "lbm";
  summary.ending = Ending::diverged;
  summary.message = "too fast";
  summary.cells_per_level = {10, 20};
  summary.time_share = {{"fluid", 0.75}, {"other", 0.25}};
  summary.results = {{"cd_stable", "", 1.2}, {"cd_peak", "", std::nullopt}, {"mass_drift", "", 1e-5}};
  summary.references =
      compare(summary.results, {{"cd_stable", 1.18, 0.10, "a paper"}, {"mass_drift", 0.0, 1e-6, "theory"}});
  const auto json = nlohmann::json::parse(to_json(summary));
  for (const char* key : {"case", "fluid", "version", "threads", "t_end", "wall_seconds", "cell_updates", "mlups",
                          "peak_rss_bytes", "cells_per_level", "time_share", "results", "references"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["diverged"], true);
  EXPECT_EQ(json["finished"], false);
  EXPECT_EQ(json["message"], "too fast");
  EXPECT_EQ(json["time_share"]["fluid"], 0.75);
  EXPECT_EQ(json["results"]["cd_stable"], 1.2);
  EXPECT_TRUE(json["results"]["cd_peak"].is_null());
  EXPECT_EQ(json["references"]["cd_stable"]["reference"], 1.18);
  EXPECT_EQ(json["references"]["cd_stable"]["agrees"], true);
  EXPECT_EQ(json["references"]["cd_stable"]["source"], "a paper");
  EXPECT_EQ(json["references"]["mass_drift"]["below"], 1e-6);
  EXPECT_EQ(json["references"]["mass_drift"]["agrees"], false);
}

TEST(Schedule, is_due_once_per_interval_whatever_the_step) {
  for (double dt : {0.0125, 0.01, 0.003}) {
    Schedule schedule(0.05);
    int count = 0;
    double time = 0.0;
    for (int step = 0; time <= 1.0 - 0.5 * dt; ++step, time += dt) count += schedule.due(time, dt) ? 1 : 0;
    EXPECT_EQ(count, 20) << "steps of " << dt;
  }
}

TEST(Schedule, zero_means_never_or_always) {
  Schedule never(0.0), always(0.0, Schedule::Zero::always);
  EXPECT_FALSE(never.due(0.0, 0.1));
  EXPECT_TRUE(always.due(0.0, 0.1));
  EXPECT_TRUE(always.due(0.1, 0.1));
}

}  // namespace
}  // namespace drogue::app

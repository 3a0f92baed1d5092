// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/results.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::app {

namespace {

using Column = std::vector<double>;
using Number = std::optional<double>;

/// Row of the largest value that counts as a peak.
std::optional<std::size_t> peak_row(const Column& time, const Column& value, const Case& c) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] >= c.results.peak_from && (!best || value[i] > value[*best])) best = i;
  }
  return best;
}

Number peak(const Column& time, const Column& value, const Case& c) {
  const auto row = peak_row(time, value, c);
  return row ? Number(value[*row]) : std::nullopt;
}

Number peak_time(const Column& time, const Column& value, const Case& c) {
  const auto row = peak_row(time, value, c);
  return row ? Number(time[*row]) : std::nullopt;
}

/// Top (x, y) of the parabola through the largest value and those beside it, for means since the row before, which
/// belong to the middle of their row; nothing unless rows on both sides are lower.
std::optional<std::array<double, 2>> peak_of_means(const Column& time, const Column& value, const Case& c) {
  const auto row = peak_row(time, value, c);
  if (!row || *row == 0 || *row + 1 == time.size()) return std::nullopt;
  const std::size_t i = *row;
  if (value[i - 1] > value[i]) return std::nullopt;  // before peaks count
  const auto middle = [&](std::size_t k) { return 0.5 * (time[k] + (k > 0 ? time[k - 1] : 0.0)); };
  const double before = middle(i - 1) - middle(i), after = middle(i + 1) - middle(i);
  const double slope_before = (value[i - 1] - value[i]) / before, slope_after = (value[i + 1] - value[i]) / after;
  const double curvature = (slope_after - slope_before) / (after - before);
  const double slope = slope_before - curvature * before;
  if (curvature >= 0.0) return std::array{middle(i), value[i]};
  return std::array{middle(i) - 0.5 * slope / curvature, value[i] - 0.25 * slope * slope / curvature};
}

Number dissipation_peak(const Column& time, const Column& value, const Case& c) {
  const auto top = peak_of_means(time, value, c);
  return top ? Number((*top)[1] * c.reference_length / std::pow(c.fluid.reference_velocity, 3)) : std::nullopt;
}

Number dissipation_peak_time(const Column& time, const Column& value, const Case& c) {
  const auto top = peak_of_means(time, value, c);
  return top ? Number((*top)[0] * c.fluid.reference_velocity / c.reference_length) : std::nullopt;
}

Number stable(const Column& time, const Column& value, const Case& c) {
  return window_mean(time, value, c.results.stable_window);
}

Number stable_drift(const Column& time, const Column& value, const Case& c) {
  return window_drift(time, value, c.results.stable_window);
}

Number largest(const Column&, const Column& value, const Case&) {
  return value.empty() ? std::nullopt : Number(*std::max_element(value.begin(), value.end()));
}

Number last(const Column&, const Column& value, const Case&) {
  return value.empty() ? std::nullopt : Number(value.back());
}

/// Mean time between rises through the middle of the range, from the first to the last.
Number mean_period(const Column& time, const Column& value) {
  if (value.empty()) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(value);
  const double middle = 0.5 * (low + high);
  std::vector<double> rises;
  for (std::size_t i = 1; i < value.size(); ++i) {
    if (!(value[i - 1] < middle && value[i] >= middle)) continue;
    rises.push_back(time[i] - (time[i] - time[i - 1]) * (value[i] - middle) / (value[i] - value[i - 1]));
  }
  if (rises.size() < 2) return std::nullopt;
  return (rises.back() - rises.front()) / static_cast<double>(rises.size() - 1);
}

Number period(const Column& time, const Column& value, const Case&) { return mean_period(time, value); }

/// Rows of the stable window: times and values; none before the run has reached its end.
std::array<Column, 2> rows_of_window(const Column& time, const Column& value, const Case& c) {
  const auto [begin, end] = c.results.stable_window;
  const double slack = 1e-9 * end;
  std::array<Column, 2> rows;
  if (time.empty() || time.back() < end - slack) return rows;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] < begin - slack || time[i] > end + slack) continue;
    rows[0].push_back(time[i]);
    rows[1].push_back(value[i]);
  }
  return rows;
}

Number peak_to_peak(const Column& time, const Column& value, const Case& c) {
  const auto [times, values] = rows_of_window(time, value, c);
  if (values.empty()) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

Number strouhal(const Column& time, const Column& value, const Case& c) {
  const auto [times, values] = rows_of_window(time, value, c);
  const Number seconds = mean_period(times, values);
  return seconds ? Number(c.reference_length / (*seconds * c.fluid.reference_velocity)) : std::nullopt;
}

struct Definition {
  std::string name, unit;
  std::string column;  ///< of the history; of a body without its name
  Number (*value)(const Column& time, const Column& value, const Case& c);
};

struct BodyDefinition : Definition {
  bool (*applies)(const Body&) = in_flow;
};

const std::vector<BodyDefinition>& body_results() {
  static const std::vector<BodyDefinition> list{
      {{"cd_peak", "", "c_d", peak}},
      {{"cd_peak_time", "s", "c_d", peak_time}},
      {{"cd_stable", "", "c_d", stable}},
      {{"cd_stable_drift", "", "c_d", stable_drift}},
      {{"centre_dx_peak", "m", "centre_dx", peak}, is_elastic},
      {{"centre_dx_peak_time", "s", "centre_dx", peak_time}, is_elastic},
      {{"centre_dx_stable", "m", "centre_dx", stable}, is_elastic},
      {{"centre_dx_stable_drift", "", "centre_dx", stable_drift}, is_elastic},
      {{"slip_normal_stable", "m/s", "slip_normal", stable}, is_elastic_in_flow},
      {{"face_difference_max", "m/s", "face_difference", largest}, is_elastic},
      {{"slip_rms_stable", "m/s", "slip_rms", stable}, is_rigid},
      {{"wake_length", "", "wake_length", last}, has_wake},
  };
  return list;
}

struct FlowDefinition : Definition {
  bool (*applies)(const Case&) = [](const Case& c) { return c.has_fluid(); };
};

const std::vector<FlowDefinition>& flow_results() {
  static const std::vector<FlowDefinition> list{
      {{"mass_drift", "", "mass_drift", last}},
      {{"dissipation_peak", "", "dissipation", dissipation_peak}, measures_energy},
      {{"dissipation_peak_time", "", "dissipation", dissipation_peak_time}, measures_energy},
      {{"velocity_error", "", "velocity_error", last}, measures_error},
      {{"residual", "", "residual", last}, measures_residual},
  };
  return list;
}

/// What may be asked of a probe, with its unit if it is not that of the probe.
struct Statistic {
  Number (*value)(const Column&, const Column&, const Case&);
  std::optional<std::string> unit;
};

Definition definition_of(const Probe& probe, const std::string& body) {
  static const std::map<std::string, Statistic> statistics{
      {"last", {last, {}}},      {"peak", {peak, {}}},          {"stable", {stable, {}}},
      {"period", {period, "s"}}, {"strouhal", {strouhal, "1"}}, {"peak_to_peak", {peak_to_peak, {}}}};
  const auto& [value, own_unit] = statistics.at(probe.statistic);
  const std::string unit = own_unit.value_or(unit_of(probe));
  return {probe.name, unit == "1" ? "" : unit, body + "." + probe.name, value};
}

/// The results that a case has, each with the full name of its column.
std::vector<Definition> results_of(const Case& c) {
  std::vector<Definition> list;
  const Body* body = summarised_body(c);
  for (BodyDefinition d : body_results()) {
    if (!body || !d.applies(*body)) continue;
    d.column = body->name + "." + d.column;
    list.push_back(d);
  }
  if (body) {
    for (const Probe& p : probes_of(*body)) list.push_back(definition_of(p, body->name));
  }
  for (const FlowDefinition& d : flow_results()) {
    if (d.applies(c)) list.push_back(d);
  }
  for (const Profile& p : c.measure.profiles) {
    if (p.has_reference()) list.push_back({"rms_" + p.name, "", "rms_" + p.name, last});
  }
  return list;
}

}  // namespace

void Trace::transfer_state(Archive& archive) {
  archive.transfer("time", time);
  for (auto& [name, values] : column) archive.transfer(name, values);
}

std::optional<double> window_mean(const Column& time, const Column& value, const std::array<double, 2>& window) {
  const double slack = 1e-9 * window[1];
  if (time.empty() || time.back() < window[1] - slack || window[1] <= window[0]) return std::nullopt;
  double sum = 0.0, weight = 0.0, before = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double inside = std::max(0.0, std::min(time[i], window[1]) - std::max(before, window[0]));
    sum += inside * value[i];
    weight += inside;
    before = time[i];
  }
  return weight > 0.0 ? std::optional(sum / weight) : std::nullopt;
}

std::optional<double> window_drift(const Column& time, const Column& value, const std::array<double, 2>& window) {
  const double middle = 0.5 * (window[0] + window[1]);
  const Number whole = window_mean(time, value, window);
  const Number first = window_mean(time, value, {window[0], middle});
  const Number second = window_mean(time, value, {middle, window[1]});
  if (!whole || !first || !second || *whole == 0.0) return std::nullopt;
  return (*second - *first) / *whole;
}

std::vector<Result> summarise(const Trace& trace, const Case& c) {
  std::vector<Result> results;
  for (const Definition& d : results_of(c)) {
    results.push_back({d.name, d.unit, d.value(trace.time, trace.column.at(d.column), c)});
  }
  return results;
}

std::vector<Comparison> compare(const std::vector<Result>& results, const std::vector<Reference>& references) {
  std::vector<Comparison> comparisons;
  for (const Reference& reference : references) {
    Comparison comparison;
    comparison.reference = reference;
    const auto result = std::ranges::find(results, reference.name, &Result::name);
    if (result != results.end() && result->value) {
      const double scale = reference.is_bound() ? 1.0 : std::abs(reference.value);
      comparison.value = result->value;
      comparison.difference = (*result->value - reference.value) / scale;
      comparison.agrees = std::abs(comparison.difference) <= reference.within;
    }
    comparisons.push_back(comparison);
  }
  return comparisons;
}

std::vector<std::string> result_names(const Case& c) {
  std::vector<std::string> names;
  for (const Definition& d : results_of(c)) names.push_back(d.name);
  return names;
}

}  // namespace drogue::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/results.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace drogue::app {

namespace {

using Column = std::vector<double>;
using Number = std::optional<double>;

/// Row of the largest value at or after `from` [s].
std::optional<std::size_t> peak_row(const Column& time, const Column& value, double from) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] >= from && (!best || value[i] > value[*best])) best = i;
  }
  return best;
}

Number peak(const Column& time, const Column& value, double from) {
  const auto row = peak_row(time, value, from);
  return row ? Number(value[*row]) : std::nullopt;
}

Number peak_time(const Column& time, const Column& value, double from) {
  const auto row = peak_row(time, value, from);
  return row ? Number(time[*row]) : std::nullopt;
}

Number largest(const Column& value) {
  return value.empty() ? std::nullopt : Number(*std::max_element(value.begin(), value.end()));
}

Number last(const Column& value) { return value.empty() ? std::nullopt : Number(value.back()); }

struct Definition {
  const char *name, *unit;
  std::function<Number(const Trace&, const ResultOptions&)> value;
  bool (*applies)(const Body&) = is_any;
};

/// The one list of results.
const std::vector<Definition>& definitions() {
  using T = const Trace&;
  using O = const ResultOptions&;
  static const std::vector<Definition> list{
      {"cd_peak", "", [](T t, O o) { return peak(t.time, t.c_d, o.peak_from); }},
      {"cd_peak_time", "s", [](T t, O o) { return peak_time(t.time, t.c_d, o.peak_from); }},
      {"cd_stable", "", [](T t, O o) { return window_mean(t.time, t.c_d, o.stable_window); }},
      {"cd_stable_drift", "", [](T t, O o) { return window_drift(t.time, t.c_d, o.stable_window); }},
      {"centre_dx_peak", "m", [](T t, O o) { return peak(t.time, t.centre_dx, o.peak_from); }, is_elastic},
      {"centre_dx_peak_time", "s", [](T t, O o) { return peak_time(t.time, t.centre_dx, o.peak_from); }, is_elastic},
      {"centre_dx_stable", "m", [](T t, O o) { return window_mean(t.time, t.centre_dx, o.stable_window); }, is_elastic},
      {"centre_dx_stable_drift", "", [](T t, O o) { return window_drift(t.time, t.centre_dx, o.stable_window); },
       is_elastic},
      {"slip_normal_stable", "m/s", [](T t, O o) { return window_mean(t.time, t.slip_normal, o.stable_window); },
       is_elastic},
      {"face_difference_max", "m/s", [](T t, O) { return largest(t.face_difference); }, is_elastic},
      {"slip_rms_stable", "m/s", [](T t, O o) { return window_mean(t.time, t.slip_rms, o.stable_window); }, is_rigid},
      {"wake_length", "", [](T t, O) { return last(t.wake_length); }, has_wake},
  };
  return list;
}

}  // namespace

void Trace::transfer_state(Archive& archive) {
  archive.transfer("time", time);
  archive.transfer("c_d", c_d);
  archive.transfer("centre_dx", centre_dx);
  archive.transfer("slip_normal", slip_normal);
  archive.transfer("face_difference", face_difference);
  archive.transfer("slip_rms", slip_rms);
  archive.transfer("wake_length", wake_length);
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

std::vector<Result> summarise(const Trace& trace, const Body& body, const ResultOptions& options) {
  std::vector<Result> results;
  for (const Definition& d : definitions()) {
    if (d.applies(body)) results.push_back({d.name, d.unit, d.value(trace, options)});
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
      comparison.value = result->value;
      comparison.difference = (*result->value - reference.value) / std::abs(reference.value);
      comparison.agrees = std::abs(comparison.difference) <= reference.within;
    }
    comparisons.push_back(comparison);
  }
  return comparisons;
}

std::vector<std::string> result_names(const Body& body) {
  std::vector<std::string> names;
  for (const Definition& d : definitions()) {
    if (d.applies(body)) names.emplace_back(d.name);
  }
  return names;
}

}  // namespace drogue::app

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "io/pending_file.hpp"

namespace drogue::app {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::string text(const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "-"; }

std::string verdict(const Comparison& c) {
  const Reference& r = c.reference;
  const std::string expected = r.is_bound() ? fmt::format("< {:.4g}", r.within) : text(r.value);
  std::string found = !c.value ? "the run ended before" : c.agrees ? "agrees" : "differs";
  if (c.value && !r.is_bound()) found = fmt::format("{:+.1f} %, {}", 100.0 * c.difference, found);
  std::vector<std::string> notes;
  if (!r.is_bound()) notes.push_back(fmt::format("within {:.3g} %", 100.0 * r.within));
  if (!r.source.empty()) notes.push_back(r.source);
  if (!notes.empty()) found += fmt::format(" ({})", fmt::join(notes, "; "));
  return fmt::format("   {:>10}  {}", expected, found);
}

Json to_json(const Comparison& c) {
  const Reference& r = c.reference;
  Json json{{"value", number(c.value)}};
  if (r.is_bound()) {
    json["below"] = r.within;
  } else {
    json["reference"] = r.value;
    json["within"] = r.within;
    json["difference"] = c.value ? Json(c.difference) : Json(nullptr);
  }
  json["agrees"] = c.agrees;
  json["source"] = r.source;
  return json;
}

void print_cost(const Summary& s, Log& log) {
  const std::int64_t cells = std::accumulate(s.cells_per_level.begin(), s.cells_per_level.end(), std::int64_t{0});
  const double gibibytes = static_cast<double>(s.peak_rss_bytes) / std::pow(1024.0, 3);
  if (cells == 0) {
    log.info("{:.4g} s in {:.1f} s, {:.2f} GiB", s.t_end, s.wall_seconds, gibibytes);
    return;
  }
  log.info("{:.4g} s of flow in {:.1f} s: {:.2f} million cells, {:.4g} updates, {:.0f} MLUPS, {:.2f} GiB", s.t_end,
           s.wall_seconds, 1e-6 * static_cast<double>(cells), static_cast<double>(s.cell_updates), s.mlups, gibibytes);
  std::vector<std::string> parts;
  for (const auto& [part, share] : s.time_share) parts.push_back(fmt::format("{} {:.0f} %", part, 100.0 * share));
  log.info("time: {}", fmt::join(parts, ", "));
}

}  // namespace

std::string to_json(const Summary& s) {
  Json json;
  json["case"] = s.case_name;
  json["title"] = s.title;
  json["fluid"] = s.fluid;
  json["version"] = s.version;
  json["threads"] = s.threads;
  json["finished"] = s.ending == Ending::finished;
  json["interrupted"] = s.ending == Ending::interrupted;
  json["diverged"] = s.ending == Ending::diverged;
  if (!s.message.empty()) json["message"] = s.message;
  json["t_end"] = s.t_end;
  json["wall_seconds"] = s.wall_seconds;
  json["cell_updates"] = s.cell_updates;
  json["mlups"] = s.mlups;
  json["peak_rss_bytes"] = s.peak_rss_bytes;
  json["cells_per_level"] = s.cells_per_level;
  json["time_share"] = Json::object();
  for (const auto& [part, share] : s.time_share) json["time_share"][part] = share;
  json["structure"] = Json::object();
  for (const auto& [body, solver] : s.structure) json["structure"][body] = solver;
  if (!s.warnings.empty()) json["warnings"] = s.warnings;
  json["results"] = Json::object();
  for (const Result& result : s.results) json["results"][result.name] = number(result.value);
  json["references"] = Json::object();
  for (const Comparison& c : s.references) json["references"][c.reference.name] = to_json(c);
  return json.dump(2) + '\n';
}

void write_summary(const Summary& summary, const std::filesystem::path& file) {
  io::PendingStream stream(file);
  stream.write(to_json(summary));
  stream.commit();
}

RunNumbers read_numbers(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const Json json = Json::parse(stream);
  RunNumbers numbers;
  for (const auto& [name, value] : json.at("results").items()) {
    if (value.is_number()) numbers.results[name] = value;
  }
  numbers.cell_updates = json.at("cell_updates");
  const double mlups = json.at("mlups");
  numbers.step_seconds = mlups > 0.0 ? 1e-6 * numbers.cell_updates / mlups : 0.0;
  return numbers;
}

void print_summary(const Summary& s, Log& log) {
  log.info("");
  print_cost(s, log);
  if (s.results.empty()) return;
  log.info("");
  log.info("{:<24} {:>10}   {:>10}  {}", "result", "value", "reference", "difference");
  for (const Result& result : s.results) {
    const std::string name = result.unit.empty() ? result.name : fmt::format("{} [{}]", result.name, result.unit);
    std::string line = fmt::format("{:<24} {:>10}", name, text(result.value));
    for (const Comparison& c : s.references) {
      if (c.reference.name == result.name) line += verdict(c);
    }
    log.info("{}", line);
  }
}

}  // namespace drogue::app

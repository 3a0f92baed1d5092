// SPDX-License-Identifier: GPL-3.0-or-later
// drogue-render: pictures of a finished or running run. Exit codes: 0 drawn, 2 a user's mistake, 1 anything else.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "core/error.hpp"
#include "render/picture.hpp"

namespace {

using namespace drogue;
using namespace drogue::render;

struct Options {
  std::filesystem::path run, output;
  std::optional<double> time;
  std::vector<double> sequence, region;
  std::vector<std::string> what;
  std::string field = "velocity", size = "1600x900", view = "auto", plane = "z=0";
  double q = 40.0;
};

Content parse_content(const std::string& what) {
  Content content;
  std::istringstream list(what);
  for (std::string item; std::getline(list, item, ',');) {
    if (item == "canopy")
      content.canopy = true;
    else if (item == "slice")
      content.slice = true;
    else if (item == "q")
      content.q = true;
    else
      throw InputError(fmt::format("--what: \"{}\" is not known; expected canopy, slice or q", item));
  }
  return content;
}

Choice parse_choice(const Options& options) {
  Choice choice;
  choice.q = options.q;
  if (options.field == "vorticity")
    choice.field = Quantity::vorticity;
  else if (options.field != "velocity")
    throw InputError(fmt::format("--field: \"{}\" is not known; expected velocity or vorticity", options.field));
  char axis = 0;
  if (std::sscanf(options.plane.c_str(), "%c=%lf", &axis, &choice.plane_position) != 2 || axis < 'x' || axis > 'z')
    throw InputError(fmt::format("--plane: \"{}\" is not a plane; expected for example z=0", options.plane));
  choice.plane_axis = axis - 'x';
  if (!options.region.empty()) {
    const auto& r = options.region;
    choice.region = Box{{r[0], r[2], r[4]}, {r[1], r[3], r[5]}};
    if ((choice.region->size().array() <= 0.0).any())
      throw InputError("--region: expected x0 x1 y0 y1 z0 z1 with x0 < x1, y0 < y1 and z0 < z1");
  }
  return choice;
}

std::array<int, 2> parse_size(const std::string& text) {
  std::array<int, 2> size{};
  if (std::sscanf(text.c_str(), "%dx%d", &size[0], &size[1]) != 2 || size[0] < 100 || size[1] < 100 || size[0] > 8000 ||
      size[1] > 8000)
    throw InputError(
        fmt::format("--size: \"{}\" is not a size; expected for example 1600x900, 100 to 8000 each", text));
  return size;
}

/// The rows drawn if nothing is asked for.
std::vector<std::string> default_what(const RunFolder& run, bool sequence) {
  if (run.fluid.empty() || (sequence && !run.canopy.empty())) return {"canopy"};
  if (run.canopy.empty()) return {"q", "slice"};
  return {"canopy,q", "canopy,slice"};
}

void render_run(const Options& options) {
  const RunFolder run = open_run(options.run);
  const bool sequence = !options.sequence.empty();
  const Choice choice = parse_choice(options);
  Picture picture{
      std::filesystem::canonical(run.folder).filename().string(), parse_size(options.size), {}, choice.field};
  Content all;
  for (const std::string& what : options.what.empty() ? default_what(run, sequence) : options.what) {
    const Content content = parse_content(what);
    picture.rows.push_back({content, named_view(options.view, content)});
    all = {all.canopy || content.canopy, all.slice || content.slice, all.q || content.q};
  }
  std::vector<Scene> scenes;
  for (double time : sequence ? options.sequence : std::vector{options.time.value_or(run.last_time())})
    scenes.push_back(load_scene(run, time, all, choice));

  for (const Scene& scene : scenes)
    if (all.q && scene.q->GetNumberOfPoints() == 0)
      fmt::print(stderr, "note: Q does not reach {} 1/s^2 at t = {:.3f} s\n", choice.q, scene.time);

  std::filesystem::path output = options.output;
  if (output.empty())
    output = run.folder / (sequence ? "sequence.png" : fmt::format("picture_{:.3f}s.png", scenes[0].time));
  draw(scenes, picture, output);
  fmt::print("{}\n", output.string());
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Draws pictures of a Drogue run. Without a display run it under: xvfb-run -a", "drogue-render"};
  app.add_option("run", options.run, "run folder")->required();
  app.add_option("-t,--time", options.time, "instant [s]; the nearest snapshot is drawn (default: the last)");
  app.add_option("--sequence", options.sequence, "several instants [s] side by side, for example 0.2,0.5,1,4")
      ->delimiter(',')
      ->excludes("--time");
  app.add_option("-o,--output", options.output, "PNG file (default: in the run folder)");
  app.add_option(
      "--what", options.what,
      "canopy,slice,q or some of them; repeated: one row of panels each (default: all there is; in a sequence canopy)");
  app.add_option("--field", options.field, "velocity or vorticity: colours slice and iso-surface")
      ->capture_default_str();
  app.add_option("--q", options.q, "value of the Q criterion on the iso-surface [1/s^2]")->capture_default_str();
  app.add_option("--plane", options.plane, "plane of the slice")->capture_default_str();
  app.add_option("--region", options.region, "part of the flow that is shown [m]: x0 x1 y0 y1 z0 z1")->expected(6);
  app.add_option("--view", options.view, "auto, iso, back, upstream, downstream, side, top")->capture_default_str();
  app.add_option("--size", options.size, "width and height in pixels")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    render_run(options);
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
  return 0;
}

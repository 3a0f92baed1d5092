// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/fluid_snapshot.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "io/hdf5_file.hpp"
#include "io/pending_file.hpp"

namespace drogue::io {
namespace {

using amr::block_cells;
using amr::block_size;

std::string level_path(int level) { return fmt::format("/VTKHDF/Level{}", level); }

std::vector<int> leaves_and_parents(const amr::Forest& forest, int level) {
  std::vector<int> blocks;
  for (const amr::Kind kind : {amr::Kind::leaf, amr::Kind::parent}) {
    const amr::BlockRange range = forest.range(level, kind);
    for (int id = range.begin; id < range.end; ++id) blocks.push_back(id);
  }
  return blocks;
}

void write_level(Hdf5File& out, const fluid::FluidSolver& fluid, int level, int gzip) {
  const amr::Forest& forest = fluid.forest();
  const std::string path = level_path(level);
  const std::vector<int> blocks = leaves_and_parents(forest, level);

  std::vector<std::int32_t> boxes;
  for (int id : blocks)
    for (int index : forest.block(id).index)
      boxes.insert(boxes.end(), {index * block_size, (index + 1) * block_size - 1});
  out.write<std::int32_t>(path + "/AMRBox", boxes, 6);
  const std::array<double, 3> spacing{forest.spacing(level), forest.spacing(level), forest.spacing(level)};
  out.write_attribute<double>(path, "Spacing", spacing);
  out.make_group(path + "/PointData");
  out.make_group(path + "/FieldData");

  const hsize_t cells = blocks.size() * block_cells;
  const Layout layout = gzip > 0 ? Layout{.chunk_rows = block_cells, .gzip = gzip} : Layout{};
  const Hdf5Handle velocity = out.make_dataset<float>(path + "/CellData/Velocity", cells, 3, layout);
  const Hdf5Handle pressure = out.make_dataset<float>(path + "/CellData/Pressure", cells, 1, layout);
  const auto fields = std::make_unique<fluid::BlockFields>();
  std::vector<float> interleaved(3 * block_cells);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    fluid.read_block(blocks[b], *fields);
    for (int cell = 0; cell < block_cells; ++cell)
      for (int a = 0; a < 3; ++a) interleaved[3 * cell + a] = fields->velocity[a][cell];
    out.write_rows(velocity, b * block_cells, block_cells, interleaved.data());
    out.write_rows(pressure, b * block_cells, block_cells, fields->pressure.data());
  }
}

FluidSnapshot::Level read_level(const Hdf5File& in, int level) {
  const std::string path = level_path(level);
  FluidSnapshot::Level result;
  result.spacing = in.read_attribute<double>(path, "Spacing").at(0);
  const auto boxes = in.read<std::int32_t>(path + "/AMRBox");
  for (std::size_t b = 0; b + 6 <= boxes.size(); b += 6) {
    Index3 block;
    for (int a = 0; a < 3; ++a) {
      block[a] = boxes[b + 2 * a] / block_size;
      if (boxes[b + 2 * a] != block[a] * block_size || boxes[b + 2 * a + 1] != (block[a] + 1) * block_size - 1)
        throw std::runtime_error(fmt::format("{}/AMRBox: row {} is not a block of {} cells", path, b / 6, block_size));
    }
    result.block.push_back(block);
  }
  result.velocity = in.read<float>(path + "/CellData/Velocity");
  result.pressure = in.read<float>(path + "/CellData/Pressure");
  const std::size_t cells = result.block.size() * block_cells;
  if (result.velocity.size() != 3 * cells || result.pressure.size() != cells)
    throw std::runtime_error(path + "/CellData does not fit AMRBox");
  return result;
}

}  // namespace

void write_fluid(const std::filesystem::path& file, const fluid::FluidSolver& fluid, int gzip) {
  PendingFile pending(file);
  Hdf5File out = Hdf5File::create(pending.path());
  const amr::Forest& forest = fluid.forest();
  const Vec3 origin = forest.domain().box.lower;
  const std::array<std::int32_t, 2> version{1, 0};
  const double time = fluid.time();

  out.make_group("/VTKHDF");
  out.write_attribute<std::int32_t>("/VTKHDF", "Version", version);
  out.write_attribute("/VTKHDF", "Type", "OverlappingAMR");
  out.write_attribute<double>("/VTKHDF", "Origin", {origin.data(), 3});
  out.write_attribute("/VTKHDF", "GridDescription", "XYZ");
  out.write_attribute<double>("/", "Time", {&time, 1});
  for (int level = 0; level < forest.levels(); ++level) write_level(out, fluid, level, gzip);
  out.close();
  pending.commit();
}

double read_fluid_time(const std::filesystem::path& file) {
  return Hdf5File::open(file).read_attribute<double>("/", "Time").at(0);
}

FluidSnapshot read_fluid(const std::filesystem::path& file) {
  const Hdf5File in = Hdf5File::open(file);
  FluidSnapshot snapshot;
  snapshot.time = in.read_attribute<double>("/", "Time").at(0);
  const auto origin = in.read_attribute<double>("/VTKHDF", "Origin");
  snapshot.origin = Vec3(origin.at(0), origin.at(1), origin.at(2));
  for (int level = 0; in.has(level_path(level)); ++level) snapshot.levels.push_back(read_level(in, level));
  if (snapshot.levels.empty()) throw std::runtime_error(file.string() + ": no levels in the snapshot");
  return snapshot;
}

}  // namespace drogue::io

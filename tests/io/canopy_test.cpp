// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/canopy.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>

#include "io/series.hpp"
#include "synthetic_run.hpp"
#include "temporary_folder.hpp"

namespace drogue {
namespace {

using test::contents;
using test::TemporaryFolder;

/// The values of an appended array, found as a reader finds it: by the offset its element names.
template <class T>
std::vector<T> appended(const std::string& text, const std::string& name) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex("Name=\"" + name + "\"[^>]*offset=\"([0-9]+)\""))) return {};
  const std::size_t start = text.find("<AppendedData encoding=\"raw\">");
  const char* data = text.data() + text.find('_', start) + 1 + std::stoul(match[1]);
  std::uint64_t bytes;
  std::memcpy(&bytes, data, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), data + sizeof bytes, bytes);
  return values;
}

TEST(Canopy, arrays_lie_where_the_header_says) {
  const TemporaryFolder folder("canopy_arrays");
  const fem::Mesh mesh = test::square_plate(4);
  const std::vector<Vec3> position = test::dome(mesh, 0.3);
  const std::vector<Vec3> velocity(mesh.nodes.size(), Vec3(1.0, 2.0, 3.0));
  std::vector<double> j(mesh.hexahedra.size());
  for (std::size_t e = 0; e < j.size(); ++e) j[e] = 1.0 + 0.01 * static_cast<double>(e);
  io::write_canopy(folder / "canopy_000003.vtu", mesh, position, velocity, {{"J", j}}, 0.75);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"canopy_000003.vtu"});

  const std::string text = contents(folder / "canopy_000003.vtu");
  const auto points = appended<double>(text, "Points");
  const auto displacement = appended<double>(text, "Displacement");
  ASSERT_EQ(points.size(), 3 * mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(points[3 * n + a], position[n][a]);
      EXPECT_EQ(displacement[3 * n + a], position[n][a] - mesh.nodes[n][a]);
    }
  EXPECT_EQ(appended<double>(text, "J"), j);
  EXPECT_EQ(appended<double>(text, "TimeValue"), std::vector<double>{0.75});
  EXPECT_EQ(appended<std::int32_t>(text, "offsets").back(), static_cast<int>(8 * mesh.hexahedra.size()));
  EXPECT_EQ(appended<std::uint8_t>(text, "types"), std::vector<std::uint8_t>(mesh.hexahedra.size(), 12));
}

TEST(Canopy, an_array_of_the_wrong_length_is_refused) {
  const TemporaryFolder folder("canopy_refused");
  const fem::Mesh mesh = test::square_plate(2);
  EXPECT_THROW(io::write_canopy(folder / "canopy.vtu", mesh, mesh.nodes, mesh.nodes, {{"J", {1.0}}}),
               std::invalid_argument);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Series, is_cut_back_with_its_files) {
  const TemporaryFolder folder("series");
  const auto series = folder / "canopy.vtu.series";
  EXPECT_TRUE(io::read_series(series).empty());
  for (int i = 0; i < 4; ++i) {
    const std::string name = "canopy_" + std::to_string(i) + ".vtu";
    std::ofstream(folder / name) << "a canopy";
    io::append_to_series(series, name, 0.1 * i);
  }
  io::cut_series(series, 0.1);
  const auto entries = io::read_series(series);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[1].name, "canopy_1.vtu");
  EXPECT_EQ(entries[1].time, 0.1);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"canopy.vtu.series", "canopy_0.vtu", "canopy_1.vtu"}));
}

TEST(Series, a_damaged_series_is_named) {
  const TemporaryFolder folder("series_damaged");
  std::ofstream(folder / "fluid.vtkhdf.series") << "{";
  EXPECT_THROW(io::read_series(folder / "fluid.vtkhdf.series"), std::runtime_error);
}

}  // namespace
}  // namespace drogue

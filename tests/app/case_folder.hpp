// SPDX-License-Identifier: GPL-3.0-or-later
// A case folder for a test, removed at its end.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "temporary_folder.hpp"

namespace drogue::app {

class CaseFolder : public test::TemporaryFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = *this / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }
};

/// A small valid case; line numbers in the tests refer to it.
inline const std::string plate_case = R"(title = "A plate"

[domain]
lower = [-1, -1, -1]
upper = [1, 1, 1]
x_min = { type = "velocity", velocity = [1, 0, 0] }
x_max = { type = "outlet" }
y_min = { type = "free_slip" }
y_max = { type = "free_slip" }
z_min = { type = "periodic" }
z_max = { type = "periodic" }

[fluid]
density = 1.2
viscosity = "1/100"
reference_velocity = 1

[grid]
coarsest = "1/16"
finest = "1/32"

[[grid.region]]
box = [[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]]

[[body]]
name = "plate"
density = 1
mesh = { type = "plate", centre = [0, 0, 0], normal = "x", size = [0.4, 0.5], thickness = 0.01, elements = [4, 5, 1] }
material = { law = "neo_hookean", young = 1000, poisson = 0.3 }

[[body.hold]]
nodes = "corners"
patch = 0.1
stiffness = 1e6

[time]
end = 2

[reference]
cd_stable = { value = 1.18, within = 0.1, source = "a paper" }
)";

/// The text with one occurrence of `from` replaced, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

}  // namespace drogue::app

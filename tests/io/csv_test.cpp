// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/csv.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"

namespace drogue::io {
namespace {

class Csv : public testing::Test {
 protected:
  ~Csv() override { std::filesystem::remove(file_); }
  std::string message(const std::string& text) {
    std::ofstream(file_) << text;
    try {
      read_csv(file_);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(file_.string().size());
    }
    return "no error";
  }

  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("drogue-csv-" + std::to_string(getpid()) + ".csv");
};

TEST_F(Csv, what_is_written_is_read) {
  write_csv(file_, {{"time [s]", "c_d [1]"}, {{0.5, 1.0, 1e-300}, {-1.25, 3e8, 0.0}}});
  const CsvTable table = read_csv(file_);
  EXPECT_EQ(table.names, (std::vector<std::string>{"time [s]", "c_d [1]"}));
  EXPECT_EQ(*table.find("time"), (std::vector{0.5, 1.0, 1e-300}));
  EXPECT_EQ(*table.find("c_d"), (std::vector{-1.25, 3e8, 0.0}));
  EXPECT_EQ(table.find("c"), nullptr);
}

TEST_F(Csv, comments_spaces_and_empty_lines_are_passed_over) {
  EXPECT_EQ(message("# a source\n\nx, y # names\r\n 1 , 2\n"), "no error");
  EXPECT_EQ(*read_csv(file_).find("y"), std::vector{2.0});
}

TEST_F(Csv, mistakes_are_named_with_their_line) {
  EXPECT_EQ(message("x,y\n1,2\n1\n"), ":3: 1 values; expected 2, one for each name of the first line");
  EXPECT_EQ(message("x,y\n1,2 m\n"), ":2: \"2 m\" is not a number");
  std::filesystem::remove(file_);
  EXPECT_THROW(read_csv(file_), InputError);
}

}  // namespace
}  // namespace drogue::io

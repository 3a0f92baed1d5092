// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/result_table.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "temporary_folder.hpp"

namespace drogue::bench {
namespace {

using test::TemporaryFolder, test::contents;

const Row columns{"name", "value", "message"};

TEST(ResultTable, goes_on_where_it_was) {
  const TemporaryFolder folder;
  const Row first{"a", "1.5", "at (1, 2), \"here\""}, second{"b", "", ""};
  ResultTable(folder / "t.csv", columns).append(first);
  ResultTable table(folder / "t.csv", columns);
  EXPECT_TRUE(table.has({"a"}));
  EXPECT_FALSE(table.has({"b"}));
  table.append(second);
  const ResultTable again(folder / "t.csv", columns);
  EXPECT_EQ(again.rows(), (std::vector<Row>{first, second}));
  EXPECT_EQ(again.value(first, "value"), 1.5);
  EXPECT_FALSE(again.value(second, "value")) << "an empty cell is no number";
}

TEST(ResultTable, forgets_a_line_that_was_cut_off) {
  const TemporaryFolder folder;
  ResultTable(folder / "t.csv", columns).append({"a", "1", ""});
  std::ofstream(folder / "t.csv", std::ios::app) << "b,2";
  ResultTable table(folder / "t.csv", columns);
  EXPECT_EQ(table.rows().size(), 1u);
  table.append({"b", "2", ""});
  EXPECT_EQ(contents(folder / "t.csv"), "name,value,message\na,1,\nb,2,\n");
}

TEST(ResultTable, refuses_the_table_of_another_version) {
  const TemporaryFolder folder;
  ResultTable(folder / "t.csv", {"name", "other"});
  EXPECT_THROW(ResultTable(folder / "t.csv", columns), InputError);
  EXPECT_NO_THROW(ResultTable(folder / "t.csv", columns, ResultTable::anew));
  EXPECT_THROW(ResultTable(folder / "no/such/folder.csv", columns), InputError);
}

}  // namespace
}  // namespace drogue::bench

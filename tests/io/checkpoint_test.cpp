// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.hpp"

#include <gtest/gtest.h>

#include "synthetic_run.hpp"

namespace drogue {
namespace {

using test::TemporaryFolder;

TEST(Checkpoint, arrays_and_numbers_read_back_bit_for_bit) {
  const TemporaryFolder folder("checkpoint_round_trip");
  const std::vector<std::byte> bytes{std::byte{0}, std::byte{255}, std::byte{7}};
  const std::vector<float> floats{1.5f, -0.1f};
  const std::vector<double> doubles{0.1, 1e-300, -3.0};
  const std::vector<std::int64_t> integers{1LL << 40, -5};
  io::CheckpointWriter out(folder / "checkpoint_000001.h5");
  out.put("lbm/level3/moments", bytes);
  out.put("lbm/scale", floats);
  out.put<double>("plate/position", std::span<const double>(doubles));
  out.put("steps", integers);
  out.put("empty", std::vector<double>{});
  out.put_number("time", 0.3);
  out.put_text("case", "square plate");
  EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint_000001.h5")) << "visible before it is complete";
  out.commit();

  const io::CheckpointReader in(folder / "checkpoint_000001.h5");
  EXPECT_EQ(in.get<std::byte>("lbm/level3/moments"), bytes);
  EXPECT_EQ(in.get<float>("lbm/scale"), floats);
  EXPECT_EQ(in.get<std::int64_t>("steps"), integers);
  std::vector<double> read(3);
  in.get<double>("plate/position", read);
  EXPECT_EQ(read, doubles);
  EXPECT_EQ(in.size("empty"), 0u);
  EXPECT_TRUE(in.get<double>("empty").empty());
  EXPECT_EQ(in.number("time"), 0.3);
  EXPECT_EQ(in.text("case"), "square plate");
  EXPECT_TRUE(in.has("lbm/level3/moments"));
  EXPECT_FALSE(in.has("lbm/level4/moments"));
}

TEST(Checkpoint, what_is_missing_or_of_another_size_is_named) {
  const TemporaryFolder folder("checkpoint_missing");
  io::CheckpointWriter out(folder / "checkpoint_000001.h5");
  out.put("position", std::vector<double>(3));
  out.commit();
  const io::CheckpointReader in(folder / "checkpoint_000001.h5");
  const auto message = [](const auto& read) {
    try {
      read();
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  std::vector<double> four(4);
  EXPECT_NE(message([&] { in.get<double>("position", four); }).find("3 values, not 4"), std::string::npos);
  EXPECT_NE(message([&] { in.get<double>("velocity"); }).find("velocity"), std::string::npos);
  EXPECT_NE(message([&] { in.number("time"); }).find("time"), std::string::npos);
}

TEST(Checkpoint, an_abandoned_one_leaves_nothing_and_keeps_what_was_there) {
  const TemporaryFolder folder("checkpoint_abandoned");
  const auto file = io::checkpoint_path(folder.path(), 1);
  {
    io::CheckpointWriter out(file);
    out.put_number("time", 1.0);
    out.commit();
  }
  {
    io::CheckpointWriter out(file);
    out.put_number("time", 2.0);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"checkpoint_000001.h5"});
  EXPECT_EQ(io::CheckpointReader(file).number("time"), 1.0);
}

TEST(Checkpoint, only_the_newest_two_are_kept) {
  const TemporaryFolder folder("checkpoint_prune");
  for (int index : {9, 10, 11, 1'000'000}) {
    io::CheckpointWriter out(io::checkpoint_path(folder.path(), index));
    out.commit();
  }
  io::prune_checkpoints(folder.path());
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"checkpoint_000011.h5", "checkpoint_1000000.h5"}));
  EXPECT_EQ(io::list_checkpoints(folder.path()).back(), io::checkpoint_path(folder.path(), 1'000'000));
  EXPECT_TRUE(io::list_checkpoints(folder / "no such folder").empty());
}

}  // namespace
}  // namespace drogue

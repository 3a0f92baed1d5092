// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.hpp"
#include "synthetic_run.hpp"
#include "temporary_folder.hpp"

namespace drogue {
namespace {

using test::TemporaryFolder;

struct Part {
  std::vector<double> series{0.1, 1e-300, -3.0};
  std::int64_t steps = 1LL << 40;

  void transfer_state(Archive& archive) {
    archive.transfer("series", series);
    archive.transfer("steps", steps);
  }
  bool operator==(const Part&) const = default;
};

struct Whole {
  std::vector<std::byte> bytes{std::byte{0}, std::byte{255}, std::byte{7}};
  std::vector<Vec3> position{Vec3(0.1, -0.2, 0.3), Vec3(1.0, 2.0, 3.0)};
  Vec3 force{1.5, 0.0, -0.1};
  double time = 0.3;
  int index = -5;
  std::vector<double> nothing;
  Part part;

  void transfer_state(Archive& archive) {
    archive.transfer("block/bytes", bytes);
    archive.transfer("position", position);
    archive.transfer("force", force);
    archive.transfer("time", time);
    archive.transfer("index", index);
    archive.transfer("nothing", nothing);
    archive.transfer("part", part);
  }
  bool operator==(const Whole&) const = default;
};

void write(const std::filesystem::path& file, Whole whole = {}) {
  io::CheckpointWriter out(file);
  out.put_number("time", whole.time);
  out.transfer("whole", whole);
  EXPECT_FALSE(std::filesystem::exists(file)) << "visible before it is complete";
  out.commit();
}

template <class Error>
std::string message(const auto& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(Checkpoint, state_reads_back_bit_for_bit) {
  const TemporaryFolder folder("checkpoint_round_trip");
  write(folder / "checkpoint_000001.h5");
  io::CheckpointReader in(folder / "checkpoint_000001.h5");
  Whole read{{3, std::byte{9}}, {2, Vec3::Zero()}, Vec3::Zero(), 0.0, 0, {1.0}, {{}, 0}};
  in.transfer("whole", read);
  EXPECT_EQ(read, Whole());
  EXPECT_EQ(in.number("time"), 0.3);
}

TEST(Checkpoint, what_is_missing_or_of_another_size_is_named) {
  const TemporaryFolder folder("checkpoint_missing");
  write(folder / "checkpoint_000001.h5");
  io::CheckpointReader in(folder / "checkpoint_000001.h5");
  std::vector<Vec3> three(3);
  EXPECT_NE(
      message<InputError>([&] { in.transfer("whole/position", three); }).find("whole/position has 6 values, not 9"),
      std::string::npos);
  Vec3 velocity;
  EXPECT_NE(message<std::runtime_error>([&] { in.transfer("whole/velocity", velocity); }).find("whole/velocity"),
            std::string::npos);
  EXPECT_NE(message<std::runtime_error>([&] { in.number("speed"); }).find("speed"), std::string::npos);
}

TEST(Checkpoint, another_format_is_refused) {
  const TemporaryFolder folder("checkpoint_format");
  auto out = io::Hdf5File::create(folder / "checkpoint_000001.h5");
  const double format = io::checkpoint_format + 1;
  out.write_attribute<double>("/", "format", {&format, 1});
  out.close();
  const std::string complaint = message<InputError>([&] { io::CheckpointReader in(folder / "checkpoint_000001.h5"); });
  EXPECT_NE(complaint.find("is of format " + std::to_string(io::checkpoint_format + 1)), std::string::npos);
}

TEST(Checkpoint, a_changed_byte_or_a_missing_end_is_noticed) {
  const TemporaryFolder folder("checkpoint_damage");
  const auto file = folder / "checkpoint_000001.h5";
  Whole whole;
  whole.bytes.assign(3 << 20, std::byte{1});
  write(file, whole);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(2 << 20).put('\2');
  EXPECT_NE(
      message<std::runtime_error>([&] { io::CheckpointReader(file).transfer("whole", whole); }).find("block/bytes"),
      std::string::npos);
  std::filesystem::resize_file(file, 2 << 20);
  EXPECT_NE(message<std::runtime_error>([&] { io::CheckpointReader in(file); }).find("could not open"),
            std::string::npos);
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

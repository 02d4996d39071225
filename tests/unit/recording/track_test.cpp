#include "swiftlet/recording/track.hpp"

#include <array>
#include <cstddef>
#include <thread>

#include <gtest/gtest.h>

namespace swiftlet::ground::track_test {

TEST(Track, KeepsRowsInOrderAndCountsDroppedRows) {
  Track<int> track(3);
  EXPECT_TRUE(track.empty());
  for (int i = 1; i <= 5; ++i) track.append(i);
  EXPECT_EQ(track.size(), 3U);
  EXPECT_EQ(track.dropped(), 2U);
  EXPECT_EQ(track[0], 1);
  EXPECT_EQ(track.back(), 3);
  EXPECT_EQ(track.end() - track.begin(), 3);
  track.clear();
  EXPECT_TRUE(track.empty());
  EXPECT_EQ(track.dropped(), 0U);
  track.append(7);
  EXPECT_EQ(track.back(), 7);
}

// A row within size() is complete while others are appended.
TEST(Track, CanBeReadWhileItIsWritten) {
  constexpr std::size_t kRows = 50'000;
  using Row = std::array<std::size_t, 8>;
  Track<Row> track(kRows);
  std::thread writer([&] {
    Row row;
    for (std::size_t i = 0; i < kRows; ++i) {
      row.fill(i);
      track.append(row);
    }
  });
  bool whole = true;
  std::size_t seen = 0;
  while (seen < kRows) {
    const std::size_t size = track.size();
    for (; seen < size; ++seen) {
      for (const std::size_t part : track[seen]) whole = whole && part == seen;
    }
  }
  writer.join();
  EXPECT_TRUE(whole);
}

}  // namespace swiftlet::ground::track_test

#include "swiftlet/plant/simulation/links/delay_line.hpp"

#include <gtest/gtest.h>

namespace swiftlet::plant::delay_line_test {

TEST(DelayLine, HoldsEachItemUntilItIsDue) {
  DelayLine<int> line(4);
  EXPECT_TRUE(line.empty());
  line.put(1, 100);
  line.put(2, 200);
  EXPECT_FALSE(line.take(99).has_value());
  EXPECT_EQ(line.take(100), 1);
  EXPECT_FALSE(line.take(199).has_value());
  EXPECT_FALSE(line.empty());
  EXPECT_EQ(line.take(1000), 2);
  EXPECT_TRUE(line.empty());
}

TEST(DelayLine, ReturnsTheNewestOfTheItemsThatAreDue) {
  DelayLine<int> line(4);
  line.put(1, 100);
  line.put(2, 110);
  line.put(3, 120);
  EXPECT_EQ(line.take(115), 2);
  EXPECT_EQ(line.take(120), 3);
}

// With a decreasing delay no item overtakes an earlier one.
TEST(DelayLine, KeepsTheOrder) {
  DelayLine<int> line(4);
  line.put(1, 300);
  line.put(2, 200);
  EXPECT_FALSE(line.take(299).has_value());
  EXPECT_EQ(line.take(300), 2);
}

TEST(DelayLine, DropsTheOldestWhenFull) {
  for (const int capacity : {1, 2, 3}) {
    DelayLine<int> line(static_cast<std::size_t>(capacity));
    const auto due_ns = [](int i) { return std::int64_t{10} * i; };
    for (int i = 1; i <= 7; ++i) line.put(i, due_ns(i));
    for (int i = 1; i <= 7; ++i) {
      const auto found = line.take(due_ns(i));
      if (i <= 7 - capacity) {
        EXPECT_FALSE(found.has_value()) << i << " of " << capacity;
      } else {
        EXPECT_EQ(found, i) << capacity;
      }
    }
  }
  DelayLine<int> none(0);
  none.put(5, 10);
  EXPECT_EQ(none.take(10), 5) << "the minimum capacity is one";
}

TEST(DelayLine, ClearDropsItemsUnderWay) {
  DelayLine<int> line(2);
  line.put(1, 500);
  line.clear();
  EXPECT_TRUE(line.empty());
  line.put(2, 100);
  EXPECT_EQ(line.take(100), 2) << "delayed by an item that was cleared";
}

}  // namespace swiftlet::plant::delay_line_test

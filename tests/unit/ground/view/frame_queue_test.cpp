#include "swiftlet/ground/view/frame_queue.hpp"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::ground::frame_queue_test {

Frame frame(std::uint32_t subscription, std::int64_t time_ns, std::size_t bytes = 10, bool is_event = false) {
  return {subscription, time_ns, std::make_shared<const mcap::Bytes>(bytes), is_event};
}

// "1@5 2@6": subscription and time of what is taken.
std::string taken(FrameQueue& queue) {
  std::string text;
  while (const auto one = queue.take())
    text +=
        (text.empty() ? "" : " ") + std::to_string(one->subscription) + "@" + std::to_string(one->time_ns);
  return text;
}

TEST(FrameQueue, HandsOutEachMessageInOrder) {
  FrameQueue queue(100, Selection::kAll);
  queue.put(frame(1, 1));
  queue.put(frame(2, 2));
  queue.put(frame(1, 3));
  EXPECT_EQ(taken(queue), "1@1 2@2 1@3");
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(FrameQueue, KeepsTheNewestOfEachSubscriptionAndTheEventsIfItIsFull) {
  FrameQueue queue(100, Selection::kAll);
  queue.put(frame(3, 0, 10, true));
  queue.put(frame(3, 1, 10, true));
  for (int i = 2; i < 10; ++i) queue.put(frame(1 + i % 2, i));
  queue.put(frame(1, 10));
  EXPECT_EQ(taken(queue), "3@0 3@1 2@9 1@10");
  EXPECT_EQ(queue.dropped(), 7U);
}

TEST(FrameQueue, NeverHoldsMoreThanItsBound) {
  FrameQueue queue(100, Selection::kAll);
  for (int i = 0; i < 1000; ++i) {
    queue.put(frame(static_cast<std::uint32_t>(i), i, 10, true));
    EXPECT_LE(queue.size(), 10U);
  }
  EXPECT_EQ(queue.dropped(), 990U);
  queue.put(frame(1, 1000, 101));
  EXPECT_EQ(queue.dropped(), 991U) << "larger than the bound";
  EXPECT_EQ(queue.take()->time_ns, 990);
}

TEST(FrameQueue, OfTheNewestCountsOnlyWhatALaterRoundReplaces) {
  FrameQueue queue(100, Selection::kNewest);
  queue.put(frame(1, 1));
  queue.put(frame(2, 2));
  queue.put(frame(1, 3));
  queue.put(frame(4, 3, 10, true));
  queue.put(frame(4, 4, 10, true));
  EXPECT_EQ(queue.dropped(), 0U);
  queue.begin_round();
  queue.put(frame(2, 5));
  EXPECT_EQ(queue.dropped(), 1U);
  EXPECT_EQ(taken(queue), "1@3 4@3 4@4 2@5");
}

TEST(FrameQueue, ForgetsASubscription) {
  FrameQueue queue(30, Selection::kAll);
  queue.put(frame(1, 1));
  queue.put(frame(2, 2));
  queue.put(frame(1, 3));
  queue.forget(1);
  queue.put(frame(3, 4));
  queue.put(frame(3, 5));
  EXPECT_EQ(taken(queue), "2@2 3@4 3@5");
  EXPECT_EQ(queue.dropped(), 0U);
}

}  // namespace swiftlet::ground::frame_queue_test

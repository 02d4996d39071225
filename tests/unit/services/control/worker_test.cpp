#include "swiftlet/services/control/worker.hpp"

#include <future>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::services::worker_test {

TEST(Worker, RunsTasksInTheirOrder) {
  std::vector<int> done;
  std::promise<void> last;
  Worker worker;
  for (int i = 0; i < 100; ++i) worker.post([&done, i] { done.push_back(i); });
  worker.post([&] { last.set_value(); });
  last.get_future().wait();
  ASSERT_EQ(done.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

// GIVEN a task that waits, and as many as may wait behind it THEN the next post returns when that task has ended.
TEST(Worker, KeepsNoMoreThanItMayAndDropsThemAtItsEnd) {
  std::promise<void> gate;
  const std::shared_future<void> opened = gate.get_future().share();
  std::promise<void> posted;
  std::future<void> is_posted = posted.get_future();
  int ran = 0;
  std::thread poster;
  {
    Worker worker;
    std::promise<void> began;
    worker.post([&] {
      began.set_value();
      opened.wait();
    });
    began.get_future().wait();
    for (std::size_t i = 0; i < Worker::kMostWaiting; ++i) worker.post([&] { ++ran; });
    poster = std::thread([&] {
      worker.post([] {});
      posted.set_value();
    });
    EXPECT_EQ(is_posted.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
    gate.set_value();
    is_posted.wait();
    poster.join();
  }
  EXPECT_LE(ran, static_cast<int>(Worker::kMostWaiting));
}

TEST(Worker, HasOrdinaryPriorityThoughARealtimeThreadStartsIt) {
  const runtime::RealtimeScope scope(1);  // has no effect where SCHED_FIFO is not permitted
  Worker worker;
  std::promise<bool> realtime;
  worker.post([&] { realtime.set_value(runtime::this_thread_is_realtime()); });
  EXPECT_FALSE(realtime.get_future().get());
}

}  // namespace swiftlet::services::worker_test

#include "swiftlet/services/runtime/realtime.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace swiftlet::runtime::realtime_test {

// Where SCHED_FIFO is not permitted, the thread stays as it is.
TEST(RealtimeScope, RaisesTheThreadForAWhile) {
  bool permitted = false;
  std::thread([&] { permitted = make_this_thread_realtime({true, 1, -1}).empty(); }).join();
  EXPECT_FALSE(this_thread_is_realtime());
  {
    const RealtimeScope none(0);
    EXPECT_FALSE(this_thread_is_realtime());
  }
  {
    const RealtimeScope outer(1);
    EXPECT_EQ(this_thread_is_realtime(), permitted);
    { const RealtimeScope inner(2); }
    EXPECT_EQ(this_thread_is_realtime(), permitted) << "the outer scope goes on";
  }
  EXPECT_FALSE(this_thread_is_realtime());
}

}  // namespace swiftlet::runtime::realtime_test

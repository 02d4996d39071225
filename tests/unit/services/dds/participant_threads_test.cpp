#include <atomic>
#include <filesystem>
#include <map>
#include <sched.h>
#include <string>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/realtime.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::dds::participant_threads_test {

using swiftlet::tests::eventually;

// The threads of this process: kernel's number and scheduling.
std::map<pid_t, int> threads() {
  std::map<pid_t, int> policies;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    const auto thread = static_cast<pid_t>(std::stol(entry.path().filename()));
    policies[thread] = ::sched_getscheduler(thread);
  }
  return policies;
}

// GIVEN a realtime_priority WHEN a thread of ordinary priority makes participant, writers and readers, and publishes THEN all
// threads of the middleware have SCHED_FIFO, those of readers included, and that thread is ordinary again. Where SCHED_FIFO is not
// permitted, all are ordinary.
TEST(Participant, AllThreadsOfTheMiddlewareHaveTheRealtimePriority) {
  bool permitted = false;
  std::thread([&] { permitted = runtime::make_this_thread_realtime({true, 1, -1}).empty(); }).join();
  const DomainLock lock;
  NodeSettings settings;
  settings.name = "ground";
  settings.domain = lock.domain();
  Node ground(settings);
  Publisher<messages::msg::Command> commands = ground.publish(messages::topics::kCommand);
  const std::map<pid_t, int> before = threads();
  settings.name = "control";
  settings.realtime_priority = 2;
  Node control(settings);
  std::atomic<pid_t> receiver{0};
  const auto sensor = control.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [](const messages::msg::Imu&) {}, Delivery::kSamples);
  const auto requests = control.subscribe<messages::msg::Command>(
      messages::topics::kCommand, [&](const messages::msg::Command&) { receiver = ::gettid(); });
  Publisher<messages::msg::Estimate> estimates = control.publish(messages::topics::kEstimate);
  ASSERT_TRUE(eventually([&] { return commands.matched() > 0; }));
  commands.publish(messages::msg::Command());
  ASSERT_TRUE(eventually([&] { return receiver != 0; }));
  estimates.publish(messages::msg::Estimate());
  EXPECT_FALSE(runtime::this_thread_is_realtime());
  int realtime = 0, ordinary = 0;
  for (const auto& [thread, policy] : threads()) {
    if (before.count(thread) == 0) ++(policy == SCHED_FIFO ? realtime : ordinary);
  }
  if (permitted) {
    EXPECT_GE(realtime, 4) << "to receive, for events and of a reader";
    EXPECT_LE(ordinary, 1) << "the one that looks after the participant rises when it takes a lock";
  } else {
    EXPECT_EQ(realtime, 0);
  }
  EXPECT_EQ(::sched_getscheduler(receiver), permitted ? SCHED_FIFO : SCHED_OTHER);
}

}  // namespace swiftlet::dds::participant_threads_test

#include "swiftlet/services/mocap/frame_thread.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/eventually.hpp"

namespace swiftlet::services::frame_thread_test {

// Brings no frame, and hangs while it is told to.
class HangingSource final : public mocap::Source {
 public:
  explicit HangingSource(const std::atomic<bool>& hangs) : hangs_(hangs) {}
  bool receive(mocap::SourceFrame&, std::chrono::milliseconds timeout) override {
    do {
      std::this_thread::sleep_for(timeout);
    } while (hangs_);
    return false;
  }
  std::string description() const override { return "none"; }

 private:
  const std::atomic<bool>& hangs_;
};

// GIVEN a motion capture that is silent WHEN its source hangs THEN the thread no longer goes on, until it does again.
TEST(FrameThreadTest, GoesOnUnlessItsSourceHangs) {
  std::atomic<bool> hangs{false};
  FrameThread frames(std::make_unique<HangingSource>(hangs), runtime::RealtimeSettings{false}, [] {});
  frames.start();
  hangs = true;
  EXPECT_TRUE(tests::eventually([&] { return !frames.goes_on(); }));
  hangs = false;
  EXPECT_TRUE(tests::eventually([&] { return frames.goes_on(); }));
}

}  // namespace swiftlet::services::frame_thread_test

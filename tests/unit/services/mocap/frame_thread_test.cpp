#include "swiftlet/services/mocap/frame_thread.hpp"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/eventually.hpp"

namespace swiftlet::services::frame_thread_test {

// Brings no frame, and hangs while it is told to.
class HangingSource final : public mocap::Source {
 public:
  bool receive(mocap::SourceFrame&, std::chrono::milliseconds timeout) override {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return hangs_; });
    changed_.wait(lock, [this] { return !hangs_; });
    return false;
  }
  void hang(bool hangs) {
    const std::lock_guard<std::mutex> lock(mutex_);
    hangs_ = hangs;
    changed_.notify_all();
  }
  std::string description() const override { return "none"; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool hangs_ = false;  // guarded by mutex_
};

// GIVEN a motion capture that is silent WHEN its source hangs THEN the thread no longer goes on, until it does again.
TEST(FrameThreadTest, GoesOnUnlessItsSourceHangs) {
  auto made = std::make_unique<HangingSource>();
  HangingSource& source = *made;
  FrameThread frames(std::move(made), runtime::RealtimeSettings{false}, [] {});
  frames.start();
  source.hang(true);
  EXPECT_TRUE(tests::eventually([&] { return !frames.goes_on(); }));
  source.hang(false);
  EXPECT_TRUE(tests::eventually([&] { return frames.goes_on(); }));
}

}  // namespace swiftlet::services::frame_thread_test

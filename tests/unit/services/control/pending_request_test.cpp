#include "swiftlet/services/control/pending_request.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace swiftlet::services {
namespace {

using State = PendingRequest::State;

TEST(PendingRequest, IsTheFirstOnes) {
  PendingRequest request;
  EXPECT_TRUE(request.claim(State::kTaken));
  EXPECT_FALSE(request.claim(State::kGivenUp));
  EXPECT_FALSE(request.claim(State::kTaken));
  EXPECT_EQ(request.state, State::kTaken);
}

// The inner loop takes it while the desk gives it up: one of them has it, and writes its outcome.
TEST(PendingRequest, IsOneThreadsAlone) {
  constexpr int kRounds = 500;
  for (int i = 0; i < kRounds; ++i) {
    PendingRequest request;
    std::atomic<int> ready{0};
    bool taken = false;
    bool given_up = false;
    const auto race = [&](State as, bool& mine) {
      ++ready;
      while (ready < 2) std::this_thread::yield();
      mine = request.claim(as);
      if (mine) request.outcome.accepted = as == State::kTaken;
    };
    std::thread loop([&] { race(State::kTaken, taken); });
    race(State::kGivenUp, given_up);
    loop.join();
    ASSERT_NE(taken, given_up);
    ASSERT_EQ(request.outcome.accepted, taken);
  }
}

}  // namespace
}  // namespace swiftlet::services

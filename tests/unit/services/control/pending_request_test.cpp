#include "swiftlet/services/control/pending_request.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace swiftlet::services::pending_request_test {

using State = PendingRequest::State;

TEST(PendingRequest, FirstClaimWins) {
  PendingRequest request;
  EXPECT_TRUE(request.claim(State::kTaken));
  EXPECT_FALSE(request.claim(State::kGivenUp));
  EXPECT_FALSE(request.claim(State::kTaken));
  EXPECT_EQ(request.state, State::kTaken);
}

// The inner loop takes the request while the command server gives it up: one of them claims it and writes its
// outcome.
TEST(PendingRequest, OneOfTwoThreadsClaimsIt) {
  constexpr int kRounds = 500;
  for (int i = 0; i < kRounds; ++i) {
    PendingRequest request;
    std::atomic<int> ready{0};
    bool taken = false;
    bool given_up = false;
    const auto race = [&](State as, bool& claimed) {
      ++ready;
      while (ready < 2) std::this_thread::yield();
      claimed = request.claim(as);
      if (claimed) request.outcome.accepted = as == State::kTaken;
    };
    std::thread loop([&] { race(State::kTaken, taken); });
    race(State::kGivenUp, given_up);
    loop.join();
    ASSERT_NE(taken, given_up);
    ASSERT_EQ(request.outcome.accepted, taken);
  }
}

}  // namespace swiftlet::services::pending_request_test

// How long a process waits for the endpoints of a rediscovered peer before it rejoins the domain.
#pragma once

#include <algorithm>
#include <chrono>

namespace swiftlet::comms {

// A rejoin makes all peers discover a new process. On a host without enough CPU time that may make them rejoin in turn:
// therefore each further rejoin waits twice as long, and processes that began together wait differently long.
class RejoinPatience {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kFirst{1000};
  static constexpr int kMostDoublings = 4;
  static constexpr std::chrono::seconds kQuiet{
      60};  // after that time without a rejoin it begins again with kFirst

  // spread: 0 to 1, of this process. It prolongs all times but the first by up to a half.
  explicit RejoinPatience(double spread) : spread_(spread) {}

  std::chrono::milliseconds at(Time now) const {
    const int doublings = doublings_at(now);
    if (doublings == 0) return kFirst;
    return std::chrono::duration_cast<std::chrono::milliseconds>(kFirst * (1 << doublings) *
                                                                 (1.0 + 0.5 * spread_));
  }
  void rejoined(Time now) {
    doublings_ = std::min(doublings_at(now) + 1, kMostDoublings);
    last_ = now;
  }

 private:
  int doublings_at(Time now) const { return now - last_ > kQuiet ? 0 : doublings_; }

  double spread_;
  int doublings_ = 0;
  Time last_{};
};

}  // namespace swiftlet::comms

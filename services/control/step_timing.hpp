// Measures rate, jitter and deadline misses of the inner loop.
#pragma once

#include <cstdint>

#include "swiftlet/services/runtime/latency_histogram.hpp"

namespace swiftlet::services {

// Counts steps since the rotors were last started. Not thread-safe. Arrival times are monotonic, ns.
class StepTiming {
 public:
  struct Figures {
    std::uint64_t cycles = 0;
    std::uint64_t deadline_misses = 0;
    double rate_hz = 0.0;
    std::int64_t longest_ns = 0;
    // The difference between the time between two steps and that between their samples' stamps. The quantiles
    // are updated every kJitterUpdate cycles.
    std::int64_t jitter_p50_ns = 0;
    std::int64_t jitter_p99_ns = 0;
    std::int64_t jitter_max_ns = 0;
  };
  static constexpr std::uint64_t kJitterUpdate = 128;

  // Call when a sample arrives. It misses its deadline if it arrives more than half a period after the
  // expected time. The expected time follows the samples before and adapts to a lasting delay within about
  // ten samples. Lost samples are not counted as misses.
  void arrived(std::uint64_t sequence, std::int64_t stamp_ns, std::int64_t now_ns, bool rotors_running);

  // Call when the command that answers the sample has been sent.
  void answered(std::int64_t now_ns);

  // The period between samples by their stamps; 0 until two consecutive samples have arrived.
  std::int64_t period_ns() const { return period_ns_; }
  const Figures& figures() const { return figures_; }

 private:
  std::uint64_t last_sequence_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t expected_ns_ = 0;  // expected arrival of the last stamp
  std::int64_t arrival_ns_ = 0;
  std::int64_t first_arrival_ns_ = 0;
  bool running_ = false;
  Figures figures_;
  runtime::LatencyHistogram jitter_;
};

}  // namespace swiftlet::services

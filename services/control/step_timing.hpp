// How punctually the inner loop runs.
#pragma once

#include <cstdint>

#include "swiftlet/services/runtime/latency_histogram.hpp"

namespace swiftlet::services {

// Counts the steps since the rotors were last started. One thread calls it; times of arrival are monotonic,
// ns.
class StepTiming {
 public:
  struct Figures {
    std::uint64_t cycles = 0;
    std::uint64_t deadline_misses = 0;
    double rate_hz = 0.0;
    std::int64_t longest_ns = 0;
    // How far the time between two steps is from that between their samples' stamps; of quantiles, the newest
    // of every kJitterUpdate cycles.
    std::int64_t jitter_p50_ns = 0;
    std::int64_t jitter_p99_ns = 0;
    std::int64_t jitter_max_ns = 0;
  };
  static constexpr std::uint64_t kJitterUpdate = 128;

  // A sample arrived. It is late if it came more than half a period after the pace that the samples before it
  // have set; the pace gives way to a lasting delay within some ten samples. Lost samples are not waited for.
  void arrived(std::uint64_t sequence, std::int64_t stamp_ns, std::int64_t now_ns, bool rotors_running);

  // The command that answers it has been sent.
  void answered(std::int64_t now_ns);

  // The period between samples, by their stamps; 0 until two in a row have come.
  std::int64_t period_ns() const { return period_ns_; }
  const Figures& figures() const { return figures_; }

 private:
  std::uint64_t last_sequence_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t pace_ns_ = 0;  // when a sample of the last stamp is expected
  std::int64_t arrival_ns_ = 0;
  std::int64_t first_arrival_ns_ = 0;
  bool running_ = false;
  Figures figures_;
  runtime::LatencyHistogram jitter_;
};

}  // namespace swiftlet::services

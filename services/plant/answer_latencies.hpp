// Measures sense-to-actuate latency: from publishing an IMU sample to receiving the command that answers it.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/services/runtime/latency_histogram.hpp"

namespace swiftlet::services {

// Not thread-safe. Times are monotonic, ns.
class AnswerLatencies {
 public:
  // A sample without an answer after kPatience further samples counts as unanswered.
  static constexpr std::uint64_t kPatience = 8;

  // late_after_ns: latency above which an answer counts as late.
  explicit AnswerLatencies(std::int64_t late_after_ns) : late_after_ns_(late_after_ns) {}

  void written(std::uint64_t imu_sequence, std::int64_t now_ns);
  // Ignores second answers and unknown samples.
  void answered(std::uint64_t imu_sequence, std::int64_t now_ns);
  void reset();

  const runtime::LatencyHistogram& times() const { return times_; }
  std::uint64_t unanswered() const { return unanswered_; }
  std::uint64_t late() const { return late_; }

 private:
  struct Sample {
    std::uint64_t sequence = 0;  // 0: none, or answered
    std::int64_t written_ns = 0;
  };

  std::array<Sample, kPatience> waiting_{};
  runtime::LatencyHistogram times_;
  std::uint64_t unanswered_ = 0;
  std::uint64_t late_ = 0;
  std::int64_t late_after_ns_;
};

}  // namespace swiftlet::services

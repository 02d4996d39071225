// Measures the delay of the loop from an IMU sample to the command that answers it, on the vehicle's clock.
#pragma once

#include <cstdint>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/runtime/latency_histogram.hpp"

namespace swiftlet::services {

// The age of each command in the sample that first reports it as obeyed: network both ways, computation, and up to one
// period. No other clock is needed. A controller that falls silent does not count. Pure; does not allocate.
class LoopDelay {
 public:
  // Delays in the last whole window with commands; -1: not known, or none has come for a window more.
  struct Figures {
    std::int64_t p50_ns = -1;
    std::int64_t p95_ns = -1;
  };
  static constexpr std::int64_t kWindowNs = 1'000'000'000;     // vehicle's clock
  static constexpr std::int64_t kFirstWindowNs = 100'000'000;  // so that it is known early

  // Call with each IMU sample.
  void sample(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed);
  const Figures& figures() const { return figures_; }

 private:
  bool started_ = false;
  std::int64_t window_end_ns_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t last_obeyed_ns_ = -1;
  runtime::LatencyHistogram ages_;
  Figures figures_;
};

}  // namespace swiftlet::services

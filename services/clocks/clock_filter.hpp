// Estimates another clock from exchanges with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "swiftlet/services/clocks/clock_exchange.hpp"

namespace swiftlet::clocks {

// Another clock, as a line over the own clock.
struct ClockEstimate {
  std::int64_t measured_ns = 0;  // own clock: of the newest exchange
  std::int64_t offset_ns = 0;    // other clock minus own clock, then
  double drift = 0.0;            // rate of the offset, s/s: 50e-6 is 50 ppm fast
  double drift_deviation = 0.0;  // standard deviation, s/s
  // Half of the mean round trip, weighted as in the fit: its two ways may differ by that, which no exchange shows.
  double half_round_trip_ns = 0.0;
  double offset_deviation_ns = 0.0;  // standard deviation of the fit, then

  // now_ns: own clock.
  std::int64_t offset_at(std::int64_t now_ns) const;
  // How wrong offset_at() may be: two standard deviations of the line and half of the round trip.
  // Grows with the age of the newest exchange.
  double uncertainty_ns(std::int64_t now_ns) const;
};

// A robust line through the offsets of the newest exchanges, in which those with the shortest round trips count most.
// Either clock may step. Does not allocate. Not thread-safe.
class ClockFilter {
 public:
  static constexpr std::size_t kWindow = 256;       // exchanges
  static constexpr std::size_t kStepExchanges = 3;  // that agree on a step of a clock

  // Returns why the exchange was refused, nullptr if it was taken.
  const char* add(const ClockExchange& exchange);

  // Without a value before the first exchange.
  const std::optional<ClockEstimate>& estimate() const { return estimate_; }
  // How often one of the clocks stepped against the other. A step is known after kStepExchanges exchanges. Until then they
  // do not change the estimate, so that one wrong exchange does no harm.
  int steps() const { return steps_; }
  // The newest exchange contradicts the estimate: maybe a step.
  bool is_in_doubt() const { return doubts_ > 0; }
  std::size_t exchanges() const { return size_; }  // in the estimate

 private:
  struct Measurement {
    std::int64_t at_ns = 0;
    std::int64_t offset_ns = 0;
    double round_trip_ns = 0.0;
  };

  struct RoundTrips {
    double shortest_ns = 0.0;
    double deviation_ns = 0.0;  // standard deviation of the offset of the shortest
  };

  bool contradicts(const Measurement& measurement) const;
  void doubt(const Measurement& measurement);
  void keep(const Measurement& measurement);
  RoundTrips round_trips() const;
  ClockEstimate fit() const;

  std::array<Measurement, kWindow> window_{};
  std::size_t size_ = 0;
  std::size_t next_ = 0;
  std::array<Measurement, kStepExchanges> doubted_{};
  std::size_t doubts_ = 0;
  std::int64_t last_asked_ns_ = 0;
  bool has_asked_ = false;
  int steps_ = 0;
  std::optional<ClockEstimate> estimate_;
};

}  // namespace swiftlet::clocks

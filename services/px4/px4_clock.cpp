#include "swiftlet/services/px4/px4_clock.hpp"

#include <algorithm>

namespace swiftlet::px4 {
namespace {

constexpr std::int64_t kLongestDelayNs = 15'000'000;  // after the fastest sample
// So many in a row that are later than that, by the same: PX4's stamps were set, or its simulation stood still. Those
// that queued up somewhere are not late by the same.
constexpr int kAwaySamples = 5;
constexpr std::int64_t kSameDelayNs = 6'000'000;
constexpr std::int64_t kLeastIntervalNs = 1'000;

}  // namespace

void Px4Clock::restart(std::int64_t delay_ns, std::int64_t arrived_ns) {
  least_ns_.fill(delay_ns);
  part_ = 0;
  part_begin_ns_ = arrived_ns;
  away_ = 0;
}

std::int64_t Px4Clock::to_host(std::uint64_t stamp_us, std::int64_t arrived_ns) {
  const std::int64_t delay_ns = arrived_ns - static_cast<std::int64_t>(stamp_us) * 1000;
  if (!is_started_) restart(delay_ns, arrived_ns);
  is_started_ = true;
  const std::int64_t least_ns = *std::min_element(least_ns_.begin(), least_ns_.end());
  const bool fits = delay_ns - least_ns < kLongestDelayNs;
  std::int64_t stamp_ns = arrived_ns;
  if (fits) {
    away_ = 0;
    if (arrived_ns - part_begin_ns_ >= kPartNs) {
      part_ = (part_ + 1) % kWindow;
      part_begin_ns_ = arrived_ns;
      least_ns_[part_] = delay_ns;
    }
    least_ns_[part_] = std::min(least_ns_[part_], delay_ns);
    stamp_ns = arrived_ns - (delay_ns - std::min(least_ns, delay_ns));
  } else {
    least_away_ns_ = away_ == 0 ? delay_ns : std::min(least_away_ns_, delay_ns);
    most_away_ns_ = away_ == 0 ? delay_ns : std::max(most_away_ns_, delay_ns);
    ++away_;
    if (most_away_ns_ - least_away_ns_ > kSameDelayNs) {
      away_ = 1;
      least_away_ns_ = most_away_ns_ = delay_ns;
    } else if (away_ >= kAwaySamples) {
      restart(least_away_ns_, arrived_ns);
      ++steps_;
    }
  }
  last_ns_ = std::max(std::min(stamp_ns, arrived_ns), last_ns_ + kLeastIntervalNs);
  return last_ns_;
}

}  // namespace swiftlet::px4

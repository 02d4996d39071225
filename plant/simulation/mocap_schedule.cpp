#include "swiftlet/plant/simulation/mocap_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

namespace {

std::int64_t shortest_interval_ns(const MocapSettings& settings) {
  const bool bounded = settings.model == MocapModel::kBounded;
  return bounded ? period_ns(settings.rate_hz) : math::nanoseconds(settings.interval_quantiles_s.front());
}

}  // namespace

MocapSchedule::MocapSchedule(const MocapSettings& settings, std::uint64_t seed)
    : settings_(settings),
      seed_(seed),
      latency_ns_(math::nanoseconds(settings.latency_s)),
      intervals_(seed, streams::kMocapIntervals),
      in_flight_(static_cast<std::size_t>(latency_ns_ / shortest_interval_ns(settings) + 2)) {}

MocapSchedule::Events MocapSchedule::advance(std::int64_t stamp_ns) {
  Events events;
  if (!last_stamp_ns_ || stamp_ns <= *last_stamp_ns_) {
    events.restarts = last_stamp_ns_.has_value();
    start(stamp_ns);
  }
  last_stamp_ns_ = stamp_ns;
  events.exposes = next_exposure_ns_ <= stamp_ns && count_ < in_flight_.size();
  while (next_exposure_ns_ <= stamp_ns) next_exposure_ns_ += interval_ns();
  if (events.exposes) {
    in_flight_[wrapped(oldest_ + count_)] = stamp_ns;
    ++count_;
  }
  events.delivers = count_ > 0 && in_flight_[oldest_] + latency_ns_ <= stamp_ns;
  if (events.delivers) {
    oldest_ = wrapped(oldest_ + 1);
    --count_;
    ++delivered_;
  }
  return events;
}

// The schedule counts from stamp 0, whatever the first stamp is.
void MocapSchedule::start(std::int64_t stamp_ns) {
  intervals_ = math::RandomStream(seed_, streams::kMocapIntervals);
  count_ = 0;
  next_exposure_ns_ = 0;
  while (next_exposure_ns_ < stamp_ns) next_exposure_ns_ += interval_ns();
}

std::int64_t MocapSchedule::interval_ns() {
  if (settings_.model == MocapModel::kBounded) return period_ns(settings_.rate_hz);
  const auto& probabilities = MocapSettings::kIntervalProbabilities;
  const auto& quantiles = settings_.interval_quantiles_s;
  const double drawn = intervals_.uniform();
  std::size_t i = 1;
  while (i + 1 < quantiles.size() && drawn >= probabilities[i]) ++i;
  const double part = (drawn - probabilities[i - 1]) / (probabilities[i] - probabilities[i - 1]);
  return math::nanoseconds(quantiles[i - 1] + part * (quantiles[i] - quantiles[i - 1]));
}

}  // namespace swiftlet::plant

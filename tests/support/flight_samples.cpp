#include "tests/support/flight_samples.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::tests {
namespace {

namespace msg = messages::msg;
namespace topics = messages::topics;

double norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

std::array<double, 3> difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

constexpr double kSide_m = 2.0;

}  // namespace

FlightSamples::FlightSamples(dds::Node& node) {
  const auto keep = [this](auto& samples, std::int64_t stamp_ns, const auto& sample) {
    const std::lock_guard<std::mutex> lock(mutex_);
    samples[stamp_ns] = sample;
  };
  subscriptions_.push_back(node.subscribe<msg::Imu>(
      topics::kImu, [this, keep](const msg::Imu& message) { keep(imu_, message.stamp_ns(), message); }));
  subscriptions_.push_back(
      node.subscribe<msg::GroundTruth>(topics::kGroundTruth, [this, keep](const msg::GroundTruth& message) {
        keep(truth_, message.stamp_ns(), Truth{message.position_ned(), message.velocity_ned()});
      }));
  subscriptions_.push_back(node.subscribe<msg::Reference>(
      topics::kReference,
      [this, keep](const msg::Reference& message) { keep(reference_, message.stamp_ns(), message); }));
}

std::int64_t FlightSamples::stamp_ns() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return imu_.empty() ? 0 : imu_.rbegin()->first;
}

double FlightSamples::speed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return truth_.empty() ? 0.0 : norm(truth_.rbegin()->second.velocity_ned);
}

double FlightSamples::z_ned() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return truth_.empty() ? 0.0 : truth_.rbegin()->second.position_ned[2];
}

std::optional<double> FlightSamples::deviation_m(std::int64_t stamp_ns) const {
  const auto truth = truth_.find(stamp_ns);
  const auto reference = reference_.find(stamp_ns);
  if (truth == truth_.end() || reference == reference_.end()) return std::nullopt;
  return norm(difference(truth->second.position_ned, reference->second.position_ned()));
}

FlightMetrics FlightSamples::metrics(std::int64_t from_ns, std::int64_t to_ns, std::int64_t period_ns) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  FlightMetrics metrics;
  std::uint32_t term = 0;
  for (auto imu = imu_.lower_bound(from_ns); imu != imu_.upper_bound(to_ns); ++imu) {
    ++metrics.samples;
    const auto gap_ns = imu->first - imu->second.obeyed().stamp_ns();
    metrics.longest_gap_ms = std::max(metrics.longest_gap_ms, math::seconds(gap_ns) * 1e3);
    if (term != 0 && imu->second.obeyed().term() != term) ++metrics.changes_of_controller;
    term = imu->second.obeyed().term();
  }
  const msg::Reference* last = nullptr;
  for (auto reference = reference_.lower_bound(from_ns); reference != reference_.upper_bound(to_ns);
       ++reference) {
    const msg::Reference& now = reference->second;
    const std::optional<double> deviation = deviation_m(reference->first);
    const std::optional<double> usual = deviation_m(reference->first - period_ns);
    if (deviation) metrics.largest_deviation_m = std::max(metrics.largest_deviation_m, *deviation);
    if (deviation && usual)
      metrics.extra_deviation_m = std::max(metrics.extra_deviation_m, *deviation - *usual);
    if (last != nullptr) {
      const double passed_s = math::seconds(now.stamp_ns() - last->stamp_ns());
      std::array<double, 3> step = difference(now.position_ned(), last->position_ned());
      for (std::size_t i = 0; i < 3; ++i) step[i] -= last->velocity_ned()[i] * passed_s;
      metrics.largest_step_m = std::max(metrics.largest_step_m, norm(step));
    }
    last = &now;
  }
  metrics.lowest_z_ned = -1e9;
  const Truth* begin = nullptr;
  for (auto truth = truth_.lower_bound(from_ns); truth != truth_.upper_bound(to_ns); ++truth) {
    const Truth& now = truth->second;
    if (begin == nullptr) begin = &now;
    metrics.lowest_z_ned = std::max(metrics.lowest_z_ned, now.position_ned[2]);
    metrics.fastest_fall_m_s = std::max(metrics.fastest_fall_m_s, now.velocity_ned[2]);
    metrics.final_distance_m = std::hypot(now.position_ned[0] - begin->position_ned[0],
                                          now.position_ned[1] - begin->position_ned[1]);
  }
  return metrics;
}

control::Mission square_laps(double speed, int laps) {
  using control::MissionItemKind;
  const double z = -1.0;
  control::Mission mission;
  mission.items.push_back({MissionItemKind::kTakeoff, {0.0, 0.0, z}, 0.0, true, 0.5, 0.0});
  for (int lap = 0; lap < laps; ++lap) {
    for (const auto& [x, y] : {std::pair{kSide_m, 0.0}, {kSide_m, kSide_m}, {0.0, kSide_m}, {0.0, 0.0}})
      mission.items.push_back({MissionItemKind::kWaypoint, {x, y, z}, 0.0, true, speed, 0.0});
  }
  mission.items.push_back({MissionItemKind::kLand, {0.0, 0.0, 0.0}, 0.0, true, 0.5, 0.0});
  return mission;
}

std::int64_t side_ns(double speed) {
  return std::llround(1e9 * control::minimum_jerk_duration(kSide_m, speed,
                                                           control::Limits().max_reference_acceleration,
                                                           control::Limits().max_reference_jerk));
}

}  // namespace swiftlet::tests

#include "swiftlet/ground/vehicle_check/rate_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/statistics.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::int64_t kLongestGap_ns = 50'000'000;  // that is bridged
constexpr std::int64_t kDelayStep_ns = 1'000'000;

double correlation_at(const GyroTrack& gyro, const std::vector<MocapRate>& mocap, std::int64_t delay_ns) {
  std::vector<double> by_gyro;
  std::vector<double> by_mocap;
  for (const MocapRate& rate : mocap) {
    const auto mean = gyro.mean(rate.from_ns - delay_ns, rate.to_ns - delay_ns);
    if (!mean) continue;
    by_gyro.push_back(mean->norm());
    by_mocap.push_back(rate.body_rates_frd.norm());
  }
  if (by_gyro.size() * 2 < mocap.size()) return 0.0;
  const double value = math::correlation(by_gyro, by_mocap);
  return std::isfinite(value) ? value : 0.0;
}

}  // namespace

GyroTrack::GyroTrack(const VehicleRecording& recording, const Eigen::Vector3d& bias_frd) {
  Eigen::Vector3d integral = Eigen::Vector3d::Zero();
  for (const auto& received : recording.imu.samples) {
    const plant::ImuSample& sample = received.sample.imu;
    if (!stamps_.empty() && sample.stamp_ns <= stamps_.back()) continue;
    if (!stamps_.empty())
      integral += (sample.body_rates_frd - bias_frd) * math::seconds(sample.stamp_ns - stamps_.back());
    stamps_.push_back(sample.stamp_ns);
    integrals_.push_back(integral);
  }
}

std::optional<Eigen::Vector3d> GyroTrack::integral(std::int64_t stamp_ns) const {
  const auto after = std::lower_bound(stamps_.begin(), stamps_.end(), stamp_ns);
  if (after == stamps_.end() || after == stamps_.begin()) return std::nullopt;
  const auto at = static_cast<std::size_t>(after - stamps_.begin());
  const std::int64_t interval_ns = stamps_[at] - stamps_[at - 1];
  if (interval_ns > kLongestGap_ns) return std::nullopt;
  const double part = static_cast<double>(stamp_ns - stamps_[at - 1]) / static_cast<double>(interval_ns);
  return integrals_[at - 1] + part * (integrals_[at] - integrals_[at - 1]);
}

std::optional<Eigen::Vector3d> GyroTrack::mean(std::int64_t from_ns, std::int64_t to_ns) const {
  const auto from = integral(from_ns);
  const auto to = integral(to_ns);
  if (!from || !to) return std::nullopt;
  return Eigen::Vector3d((*to - *from) / math::seconds(to_ns - from_ns));
}

Eigen::Vector3d GyroTrack::total() const {
  return integrals_.empty() ? Eigen::Vector3d::Zero() : integrals_.back();
}

std::vector<MocapRate> mocap_rates(const VehicleRecording& recording) {
  std::vector<MocapRate> rates;
  const auto& samples = recording.mocap.samples;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const plant::PoseSample& before = samples[i - 1].sample;
    const plant::PoseSample& now = samples[i].sample;
    const std::int64_t interval_ns = now.stamp_ns - before.stamp_ns;
    if (!before.tracked || !now.tracked || interval_ns <= 0 || interval_ns > kLongestGap_ns) continue;
    const Eigen::Quaterniond turn = before.q_ned_from_frd.conjugate() * now.q_ned_from_frd;
    rates.push_back(
        {before.stamp_ns, now.stamp_ns, math::rotation_vector(turn) / math::seconds(interval_ns)});
  }
  return rates;
}

Delay find_delay(const GyroTrack& gyro, const std::vector<MocapRate>& mocap, double longest_s) {
  Delay best;
  const std::int64_t longest_ns = math::nanoseconds(longest_s);
  for (std::int64_t delay_ns = -longest_ns; delay_ns <= longest_ns; delay_ns += kDelayStep_ns) {
    const double fit = correlation_at(gyro, mocap, delay_ns);
    if (fit > best.correlation) best = {math::seconds(delay_ns), fit};
  }
  return best;
}

}  // namespace swiftlet::ground

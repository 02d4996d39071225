#include "plant/simulation/mocap.hpp"

#include <cmath>

#include "plant/simulation/streams.hpp"

namespace swiftlet::plant {

namespace {

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * static_cast<double>(kNanosecondsPerSecond));
}

// Rotation by a small vector, in radians; off by less than |v|^3 / 12.
Eigen::Quaterniond small_rotation(const Eigen::Vector3d& vector) {
  const Eigen::Vector3d half = 0.5 * vector;
  const double scale = 1.0 / std::sqrt(1.0 + half.x() * half.x() + half.y() * half.y() + half.z() * half.z());
  return {scale, scale * half.x(), scale * half.y(), scale * half.z()};
}

}  // namespace

Mocap::Mocap(const MocapSettings& settings, std::uint64_t seed)
    : settings_(settings),
      period_ns_(period_ns(settings.rate_hz)),
      latency_ns_(nanoseconds(settings.latency_s)),
      dropout_length_ns_(nanoseconds(settings.dropout_length_s)),
      misalignment_(small_rotation(settings.misalignment_rad *
                                   RandomStream(seed, streams::kMocapMisalignment).on_unit_sphere())),
      position_noise_(seed, streams::kMocapPosition),
      orientation_noise_(seed, streams::kMocapOrientation),
      dropouts_(seed, streams::kMocapDropouts),
      in_flight_(static_cast<std::size_t>(latency_ns_ / period_ns_ + 2)) {}

std::optional<PoseSample> Mocap::update(const TruthSample& truth) {
  const std::int64_t frame = truth.stamp_ns / period_ns_;
  if (last_stamp_ns_ && truth.stamp_ns <= *last_stamp_ns_) {
    last_stamp_ns_.reset();
    dropout_end_ns_.reset();
    count_ = 0;
  }
  const bool exposed = last_stamp_ns_ ? frame > last_frame_ : truth.stamp_ns % period_ns_ == 0;
  last_stamp_ns_ = truth.stamp_ns;
  last_frame_ = frame;
  if (exposed && count_ < in_flight_.size()) {
    in_flight_[(oldest_ + count_) % in_flight_.size()] = expose(truth);
    ++count_;
  }
  if (count_ == 0 || in_flight_[oldest_].stamp_ns + latency_ns_ > truth.stamp_ns) return std::nullopt;
  const PoseSample due = in_flight_[oldest_];
  oldest_ = (oldest_ + 1) % in_flight_.size();
  --count_;
  return due;
}

PoseSample Mocap::expose(const TruthSample& truth) {
  PoseSample pose;
  pose.stamp_ns = truth.stamp_ns;
  pose.sequence = ++sequence_;
  pose.tracked = !in_dropout(truth.stamp_ns);
  // Drawn for untracked frames too: a dropout does not change the frames after it.
  const Eigen::Vector3d position_error = settings_.position_error_m * position_noise_.in_unit_ball();
  const Eigen::Vector3d orientation_error =
      settings_.orientation_error_rad * orientation_noise_.in_unit_ball();
  if (!pose.tracked) return pose;
  pose.position_ned = truth.position_ned + position_error;
  pose.q_ned_from_frd = truth.q_ned_from_frd * misalignment_ * small_rotation(orientation_error);
  return pose;
}

bool Mocap::in_dropout(std::int64_t stamp_ns) {
  const bool begins = dropouts_.uniform() < settings_.dropout_probability;
  if (dropout_end_ns_ && stamp_ns < *dropout_end_ns_) return true;
  if (!begins) return false;
  dropout_end_ns_ = stamp_ns + dropout_length_ns_;
  return true;
}

std::uint64_t newest_mocap_sequence(const MocapSettings& settings, std::int64_t truth_period_ns,
                                    std::int64_t stamp_ns) {
  const std::int64_t newest_exposure_ns = stamp_ns - nanoseconds(settings.latency_s);
  if (newest_exposure_ns < 0) return 0;
  const std::int64_t on_grid_ns = newest_exposure_ns / truth_period_ns * truth_period_ns;
  return static_cast<std::uint64_t>(on_grid_ns / period_ns(settings.rate_hz)) + 1;
}

bool mocap_needs_truth(const MocapSettings& settings, std::int64_t truth_period_ns, std::int64_t stamp_ns) {
  const std::int64_t before_ns = stamp_ns - truth_period_ns;
  if (before_ns < 0) return true;
  const std::int64_t period = period_ns(settings.rate_hz);
  const bool exposes = stamp_ns / period > before_ns / period;
  return exposes || newest_mocap_sequence(settings, truth_period_ns, stamp_ns) >
                        newest_mocap_sequence(settings, truth_period_ns, before_ns);
}

}  // namespace swiftlet::plant

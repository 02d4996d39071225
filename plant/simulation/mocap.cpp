#include "swiftlet/plant/simulation/mocap.hpp"

#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

namespace {

// Unit quaternion of a small rotation vector, rad. The error is below |v|^3 / 12.
Eigen::Quaterniond small_rotation(const Eigen::Vector3d& vector) {
  const Eigen::Vector3d half = 0.5 * vector;
  const double scale = 1.0 / std::sqrt(1.0 + half.x() * half.x() + half.y() * half.y() + half.z() * half.z());
  return {scale, scale * half.x(), scale * half.y(), scale * half.z()};
}

}  // namespace

Mocap::Mocap(const MocapSettings& settings, std::uint64_t seed)
    : settings_(settings),
      schedule_(settings, seed),
      dropout_length_ns_(math::nanoseconds(settings.dropout_length_s)),
      misalignment_(small_rotation(settings.misalignment_rad *
                                   math::RandomStream(seed, streams::kMocapMisalignment).on_unit_sphere())),
      position_noise_(seed, streams::kMocapPosition),
      orientation_noise_(seed, streams::kMocapOrientation),
      dropouts_(seed, streams::kMocapDropouts),
      in_flight_(schedule_.capacity()) {}

std::optional<PoseSample> Mocap::update(std::int64_t stamp_ns, const Eigen::Vector3d& position_ned,
                                        const Eigen::Quaterniond& q_ned_from_frd) {
  const MocapSchedule::Events events = schedule_.advance(stamp_ns);
  if (events.restarts) {
    dropout_end_ns_.reset();
    count_ = 0;
  }
  if (events.exposes) {
    in_flight_[wrapped(oldest_ + count_)] = expose(stamp_ns, position_ned, q_ned_from_frd);
    ++count_;
  }
  if (!events.delivers) return std::nullopt;
  const PoseSample due = in_flight_[oldest_];
  oldest_ = wrapped(oldest_ + 1);
  --count_;
  return due;
}

PoseSample Mocap::expose(std::int64_t stamp_ns, const Eigen::Vector3d& position_ned,
                         const Eigen::Quaterniond& q_ned_from_frd) {
  PoseSample pose;
  pose.stamp_ns = stamp_ns;
  pose.sequence = ++sequence_;
  pose.tracked = !in_dropout(stamp_ns);
  // Errors are drawn for untracked frames too, so that a dropout does not change the frames after it.
  const Eigen::Vector3d position_error = settings_.position_error_m * error(position_noise_);
  const Eigen::Vector3d orientation_error = settings_.orientation_error_rad * error(orientation_noise_);
  if (!pose.tracked) return pose;
  pose.position_ned = position_ned + position_error;
  pose.q_ned_from_frd = q_ned_from_frd * misalignment_ * small_rotation(orientation_error);
  return pose;
}

Eigen::Vector3d Mocap::error(math::RandomStream& noise) const {
  return settings_.model == MocapModel::kBounded ? noise.in_unit_ball() : noise.normal3();
}

bool Mocap::in_dropout(std::int64_t stamp_ns) {
  const bool begins = dropouts_.uniform() < settings_.dropout_probability;
  if (dropout_end_ns_ && stamp_ns < *dropout_end_ns_) return true;
  if (!begins) return false;
  dropout_end_ns_ = stamp_ns + dropout_length_ns_;
  return true;
}

}  // namespace swiftlet::plant

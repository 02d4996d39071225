#include "swiftlet/identification/mocap/motion_recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace swiftlet::identification {
namespace {

using Eigen::Vector3d;

constexpr double kMostPoses = 20000;
constexpr double kLongestGap_s = 0.25;  // in the samples or poses, that the motion continues over
constexpr double kGroundRange_m =
    0.3;  // more than this between the lowest and the highest pose: it took off or landed
constexpr double kAirborne_m = 0.1;        // above the lowest pose
constexpr double kHalfSmoothing_s = 0.02;  // half the window of the readings at a pose

// Poses in the air: on the ground, samples of the IMU miss most of what the contact does.
std::vector<FlightPose> airborne(const std::vector<FlightPose>& poses) {
  if (poses.empty()) return poses;
  const auto is_higher = [](const FlightPose& a, const FlightPose& b) {
    return a.position_ned.z() > b.position_ned.z();
  };
  const auto [lowest, highest] = std::minmax_element(poses.begin(), poses.end(), is_higher);
  const double ground_z = lowest->position_ned.z();
  if (ground_z - highest->position_ned.z() < kGroundRange_m) return poses;
  const auto flies = [&](const FlightPose& pose) { return ground_z - pose.position_ned.z() > kAirborne_m; };
  return {std::find_if(poses.begin(), poses.end(), flies),
          std::find_if(poses.rbegin(), poses.rend(), flies).base()};
}

// Means around a row, so that their noise does not pass for motion.
void add_readings(const FlightLog& log, std::size_t row, MotionRecording& out) {
  std::size_t first = row;
  std::size_t last = row;
  while (first > 0 && log.time_s[row] - log.time_s[first - 1] < kHalfSmoothing_s) --first;
  while (last + 1 < log.size() && log.time_s[last + 1] - log.time_s[row] < kHalfSmoothing_s) ++last;
  Vector3d force = Vector3d::Zero();
  Vector3d rates = Vector3d::Zero();
  for (std::size_t i = first; i <= last; ++i) {
    force += log.specific_force_frd[i];
    rates += log.body_rates_frd[i];
  }
  const auto count = static_cast<double>(last - first + 1);
  out.force.push_back(force / count);
  out.rates.push_back(rates / count);
}

}  // namespace

// Between two samples the mean of both holds.
MotionRecording recording_of(const FlightLog& log) {
  MotionRecording out;
  const double duration_s = log.time_s.back() - log.time_s.front();
  const double interval_s = std::max(kShortestPoseInterval_s, duration_s / kMostPoses);
  std::size_t row = 1;
  for (const FlightPose& pose : airborne(log.poses)) {
    if (pose.time_s < log.time_s.front()) continue;
    if (pose.time_s > log.time_s.back()) break;
    if (!out.poses.empty() && pose.time_s - out.poses.back().time_s < interval_s) continue;
    MotionRecording::Interval interval;
    double time_s = out.poses.empty() ? pose.time_s : out.poses.back().time_s;
    interval.duration_s = pose.time_s - time_s;
    interval.is_gap = interval.duration_s > kLongestGap_s;
    for (;; ++row) {
      interval.is_gap = interval.is_gap || log.time_s[row] - log.time_s[row - 1] > kLongestGap_s;
      const double end_s = std::min(log.time_s[row], pose.time_s);
      if (end_s > time_s) {
        interval.readings.push_back({end_s - time_s,
                                     0.5 * (log.specific_force_frd[row - 1] + log.specific_force_frd[row]),
                                     0.5 * (log.body_rates_frd[row - 1] + log.body_rates_frd[row])});
        time_s = end_s;
      }
      if (log.time_s[row] >= pose.time_s) break;
    }
    if (!out.poses.empty()) out.intervals.push_back(std::move(interval));
    out.poses.push_back(pose);
    add_readings(log, row, out);
  }
  return out;
}

double MotionRecording::rms_rates() const {
  Vector3d mean = Vector3d::Zero();
  double squares = 0.0;
  for (const Vector3d& rate : rates) {
    mean += rate;
    squares += rate.squaredNorm();
  }
  const auto count = static_cast<double>(rates.size());
  return std::sqrt(squares / count - (mean / count).squaredNorm());
}

double noise_density(const std::vector<double>& time_s, const std::vector<Vector3d>& values, double least) {
  constexpr double kDeviationOverMedian = 1.4826;  // of the absolute value of a normal distribution
  std::vector<double> differences;
  for (std::size_t i = 2; i < values.size(); ++i) {
    const Vector3d difference = values[i] - 2.0 * values[i - 1] + values[i - 2];
    for (int axis = 0; axis < 3; ++axis) differences.push_back(std::abs(difference[axis]));
  }
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  const double deviation = kDeviationOverMedian * *middle / std::sqrt(6.0);
  const double period_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  return std::max(least, deviation * std::sqrt(period_s));
}

}  // namespace swiftlet::identification

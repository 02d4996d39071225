#include "swiftlet/ground/vehicle_check/imu_range.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/core.h>

namespace swiftlet::ground {
namespace {

// A hand cannot turn or jerk a vehicle by this much from one sample to the next.
constexpr double kGyroStep_rad_s = 3.0;
constexpr double kForceStep_m_s2 = 60.0;
constexpr double kNearTheEnd = 0.6;  // of the largest value: both sides of an overflow lie there
constexpr int kSaturated = 5;        // samples in a row at the largest value

struct Axis {
  const char* name;  // "gyro x"
  const char* unit;
  double step;  // no motion of a hand
  std::vector<double> values;
};

std::vector<Axis> axes_of(const VehicleRecording& recording) {
  std::vector<Axis> axes;
  for (Eigen::Index i = 0; i < 3; ++i) {
    static constexpr const char* kGyro[] = {"gyro x", "gyro y", "gyro z"};
    static constexpr const char* kForce[] = {"accelerometer x", "accelerometer y", "accelerometer z"};
    Axis gyro{kGyro[i], "rad/s", kGyroStep_rad_s, {}};
    Axis force{kForce[i], "m/s^2", kForceStep_m_s2, {}};
    for (const auto& received : recording.imu.samples) {
      gyro.values.push_back(received.sample.imu.body_rates_frd(i));
      force.values.push_back(received.sample.imu.specific_force_frd(i));
    }
    axes.push_back(std::move(gyro));
    axes.push_back(std::move(force));
  }
  return axes;
}

double largest(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::size_t overflows(const Axis& axis) {
  const double end = kNearTheEnd * largest(axis.values);
  std::size_t count = 0;
  for (std::size_t i = 1; i < axis.values.size(); ++i) {
    const double before = axis.values[i - 1];
    const double now = axis.values[i];
    if (before * now < 0.0 && std::abs(now - before) > axis.step && std::abs(before) > end &&
        std::abs(now) > end)
      ++count;
  }
  return count;
}

bool is_saturated(const Axis& axis) {
  const double most = largest(axis.values);
  if (2.0 * most < axis.step) return false;  // too small to tell from a sensor at rest
  int in_a_row = 0;
  for (const double value : axis.values) {
    in_a_row = std::abs(value) == most ? in_a_row + 1 : 0;
    if (in_a_row >= kSaturated) return true;
  }
  return false;
}

CheckResult check_overflow(const std::vector<Axis>& axes) {
  std::size_t total = 0;
  std::string finding;
  for (const Axis& axis : axes) {
    const std::size_t count = overflows(axis);
    total += count;
    if (count > 0 && finding.empty())
      finding = fmt::format("16-bit wrap-around: {} jumps between +{:.2f} and -{:.2f} {}", axis.name,
                            largest(axis.values), largest(axis.values), axis.unit);
  }
  return judged("imu.wrap_around", figure(static_cast<double>(total), "", 0, " jumps from end to end"),
                "none", finding);
}

CheckResult check_saturation(const std::vector<Axis>& axes) {
  std::size_t total = 0;
  std::string finding;
  for (const Axis& axis : axes) {
    if (!is_saturated(axis)) continue;
    ++total;
    if (finding.empty())
      finding = fmt::format("{} saturates at {:.2f} {} in motion of a hand: its range is too small",
                            axis.name, largest(axis.values), axis.unit);
  }
  return judged("imu.saturation", figure(static_cast<double>(total), "", 0, " axes saturated"), "none",
                finding);
}

}  // namespace

CheckResults check_imu_range(const VehicleRecording& recording) {
  if (recording.imu.samples.empty()) return {missing("imu.wrap_around", "missing: no imu message arrived")};
  const std::vector<Axis> axes = axes_of(recording);
  return {check_overflow(axes), check_saturation(axes)};
}

}  // namespace swiftlet::ground

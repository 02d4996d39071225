// The estimate of a simulated vehicle that brings it in place of IMU samples: one for each of them. It is that of the on-board
// estimator, on IMU and motion capture, or that of position sensors of the vehicle's own, which motion capture does not
// correct: the ground truth with a position and a heading that drift smoothly.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/firmware/onboard_estimator.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

class Odometry {
 public:
  // Precondition: settings.odometry.source is not kNone.
  Odometry(const SimulationSettings& settings, std::uint64_t seed);

  // At the stamp of the IMU sample, whose body rates it takes. onboard: propagated to it.
  OdometrySample sample(const ImuSample& imu, const VehicleState& truth, const OnboardEstimator& onboard);

 private:
  // Errors of north, east, down (m) and heading (rad): each the position of a critically damped oscillator that white noise
  // drives, so that the error of the velocity is its derivative.
  void drift(double dt_s);
  void jump(std::int64_t stamp_ns, OdometrySample& sample);

  OdometrySettings settings_;
  FaultSchedule faults_;
  math::RandomStream random_;
  Eigen::Vector4d sigma_;
  Eigen::Vector4d error_;
  Eigen::Vector4d error_rate_;
  std::int64_t last_ns_ = -1;
  const Fault* jumped_ = nullptr;
  std::uint32_t resets_ = 0;
};

}  // namespace swiftlet::plant

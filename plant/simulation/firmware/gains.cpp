#include "swiftlet/plant/simulation/firmware/gains.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::plant {
namespace {

constexpr double kDamping = 0.8;               // of the rate loop
constexpr double kApparentLag_s = 0.02;        // of the motors, with the derivative part
constexpr double kHighestDerivative = 3.5;     // beyond it the noise of the gyro dominates
constexpr double kHighestYawDerivative = 1.0;  // the rotors have little moment about yaw
constexpr double kIntegralTime_s = 0.5;        // p / i of the rate loop
constexpr double kAttitudeCascade = 3.0;       // bandwidth of the rate loop over that of the attitude loop
constexpr double kFastestAttitude = 10.0;      // 1/s
constexpr double kVelocityCascade = 2.5;
constexpr double kPositionCascade = 2.0;

struct RateLoopOfAxis {
  double p, d, bandwidth;
};

// With the lag tau of the motors the rate loop is tau s^2 + (1 + d) s + p: d shortens the lag to tau / (1 + d), p gives
// the damping.
RateLoopOfAxis rate_loop(double lag_s, double highest_derivative) {
  const double d = std::clamp(lag_s / kApparentLag_s - 1.0, 0.0, highest_derivative);
  const double p = (1.0 + d) * (1.0 + d) / (4.0 * kDamping * kDamping * lag_s);
  return {p, d, std::sqrt(p / lag_s)};
}

}  // namespace

FirmwareGains firmware_gains(const Vehicle& vehicle) {
  const double lag_s = vehicle.motor.time_constant_s;
  const RateLoopOfAxis tilt = rate_loop(lag_s, kHighestDerivative);
  const RateLoopOfAxis yaw = rate_loop(lag_s, kHighestYawDerivative);
  FirmwareGains gains;
  gains.rates.p = {tilt.p, tilt.p, yaw.p};
  gains.rates.i = gains.rates.p / kIntegralTime_s;
  gains.rates.d = {tilt.d, tilt.d, yaw.d};
  const double attitude = std::min(tilt.bandwidth / kAttitudeCascade, kFastestAttitude);
  gains.attitude.p = {attitude, attitude, std::min(yaw.bandwidth / kAttitudeCascade, attitude)};
  gains.position.velocity_p = attitude / kVelocityCascade;
  gains.position.position_p = gains.position.velocity_p / kPositionCascade;
  gains.position.velocity_i = 0.5 * gains.position.velocity_p;
  return gains;
}

}  // namespace swiftlet::plant

#include "plant/simulation/settings.hpp"

#include <cmath>
#include <limits>
#include <sstream>

namespace swiftlet::plant {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Rules {
 public:
  void within(const std::string& key, double value, double min, double max) {
    if (value >= min && value <= max) return;
    std::ostringstream message;
    message << "is " << value << ", must be ";
    if (max == kInfinity) {
      message << "at least " << min;
    } else {
      message << "at least " << min << " and at most " << max;
    }
    add(key, message.str());
  }

  void within(const std::string& key, const Eigen::Vector3d& value, double min, double max) {
    for (int i = 0; i < 3; ++i) within(key + "[" + std::to_string(i) + "]", value[i], min, max);
  }

  // Samples fall on the ends of steps.
  void whole_steps(const std::string& key, double rate_hz, std::int64_t step_ns) {
    if (!(rate_hz > 0.0) || step_ns <= 0) return;
    const double period = 1.0e9 / rate_hz;
    const std::int64_t rounded = period_ns(rate_hz);
    if (std::abs(period - static_cast<double>(rounded)) < 1.0e-6 * period && rounded % step_ns == 0) return;
    std::ostringstream message;
    message << "is " << rate_hz << ", must be such that its period is a whole number of steps of "
            << static_cast<double>(step_ns) * 1.0e-9 << " s";
    add(key, message.str());
  }

  std::vector<Violation> take() { return std::move(violations_); }

 private:
  void add(const std::string& key, const std::string& message) { violations_.push_back({key, message}); }

  std::vector<Violation> violations_;
};

}  // namespace

std::int64_t period_ns(double rate_hz) {
  return rate_hz > 0.0 ? std::llround(static_cast<double>(kNanosecondsPerSecond) / rate_hz) : 0;
}

std::vector<Violation> validate(const SimulationSettings& settings) {
  Rules rules;
  rules.within("step_s", static_cast<double>(settings.step_ns) * 1.0e-9, 1.0e-5, 0.002);
  rules.within("command_timeout_s", settings.command_timeout_s, 0.01, 10.0);
  rules.within("rotor_speed_rate_hz", settings.rotor_speed_rate_hz, 0.0, 2000.0);
  rules.whole_steps("rotor_speed_rate_hz", settings.rotor_speed_rate_hz, settings.step_ns);

  const ImuSettings& imu = settings.imu;
  rules.within("imu.rate_hz", imu.rate_hz, 50.0, 8000.0);
  rules.whole_steps("imu.rate_hz", imu.rate_hz, settings.step_ns);
  rules.within("imu.accelerometer_noise_density", imu.accelerometer_noise_density, 0.0, 1.0);
  rules.within("imu.gyro_noise_density", imu.gyro_noise_density, 0.0, 1.0);
  rules.within("imu.accelerometer_bias_sigma", imu.accelerometer_bias_sigma, 0.0, 10.0);
  rules.within("imu.gyro_bias_sigma", imu.gyro_bias_sigma, 0.0, 1.0);
  rules.within("imu.accelerometer_bias_walk", imu.accelerometer_bias_walk, 0.0, 1.0);
  rules.within("imu.gyro_bias_walk", imu.gyro_bias_walk, 0.0, 1.0);
  rules.within("imu.accelerometer_range", imu.accelerometer_range, 2.0 * kGravity, kInfinity);
  rules.within("imu.gyro_range", imu.gyro_range, 1.0, kInfinity);

  const MocapSettings& mocap = settings.mocap;
  rules.within("mocap.rate_hz", mocap.rate_hz, 1.0, 1000.0);
  rules.within("mocap.latency_s", mocap.latency_s, 0.0, 1.0);
  rules.within("mocap.position_error_m", mocap.position_error_m, 0.0, 1.0);
  rules.within("mocap.orientation_error_rad", mocap.orientation_error_rad, 0.0, 0.5);
  rules.within("mocap.misalignment_rad", mocap.misalignment_rad, 0.0, 0.5);
  rules.within("mocap.dropout_probability", mocap.dropout_probability, 0.0, 1.0);
  rules.within("mocap.dropout_length_s", mocap.dropout_length_s, 0.0, 60.0);

  rules.within("supply.initial_state_of_charge", settings.supply.initial_state_of_charge, 0.0, 1.0);
  rules.within("supply.rate_hz", settings.supply.rate_hz, 1.0, 1000.0);
  rules.whole_steps("supply.rate_hz", settings.supply.rate_hz, settings.step_ns);

  rules.within("air.wind_ned", settings.air.wind_ned, -30.0, 30.0);
  rules.within("air.gust_sigma_ned", settings.air.gust_sigma_ned, 0.0, 10.0);
  rules.within("air.gust_time_constant_s", settings.air.gust_time_constant_s, 0.01, 1000.0);

  rules.within("ground.leg_height_m", settings.ground.leg_height_m, 0.0, 1.0);
  rules.within("ground.friction", settings.ground.friction, 0.0, 10.0);
  return rules.take();
}

}  // namespace swiftlet::plant

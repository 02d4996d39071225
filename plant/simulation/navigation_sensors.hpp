// The sensors of an autopilot with an estimator of its own, beside the IMU: barometer, magnetometer, GPS. Their
// samples are taken with the first sample of the IMU that is not earlier than their time.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/barometer.hpp"
#include "swiftlet/plant/simulation/gps.hpp"
#include "swiftlet/plant/simulation/magnetometer.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

// The samples of a stamp; empty if none is due.
struct NavigationSamples {
  std::optional<BarometerSample> barometer;
  std::optional<Eigen::Vector3d> magnetic_field_frd;  // gauss
  std::optional<GpsSample> gps;
};

class NavigationSensors {
 public:
  // Precondition: validate(settings) is empty.
  NavigationSensors(const SimulationSettings& settings, std::uint64_t seed);

  // Call it with the truth at each sample of the IMU.
  NavigationSamples sample(const TruthSample& truth);

 private:
  struct Schedule {
    std::int64_t period_ns;  // 0: never
    std::int64_t next_ns = 0;

    bool due(std::int64_t stamp_ns) {
      if (period_ns == 0 || stamp_ns < next_ns) return false;
      next_ns += period_ns;
      return true;
    }
  };

  double site_altitude_m_;
  Barometer barometer_;
  Magnetometer magnetometer_;
  std::optional<Gps> gps_;
  Schedule barometer_schedule_;
  Schedule magnetometer_schedule_;
  Schedule gps_schedule_;
};

}  // namespace swiftlet::plant

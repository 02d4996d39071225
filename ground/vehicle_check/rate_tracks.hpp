// Body rates of a recording by the gyro and by motion capture, to compare them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// The integral of the body rates over time.
class GyroTrack {
 public:
  // bias_frd: rad/s, removed from the samples.
  GyroTrack(const VehicleRecording& recording, const Eigen::Vector3d& bias_frd);

  // Mean rates between two stamps; nullopt outside of the recording or across a gap.
  std::optional<Eigen::Vector3d> mean(std::int64_t from_ns, std::int64_t to_ns) const;
  // From the first sample to the last, rad.
  Eigen::Vector3d total() const;

 private:
  std::optional<Eigen::Vector3d> integral(std::int64_t stamp_ns) const;

  std::vector<std::int64_t> stamps_;
  std::vector<Eigen::Vector3d> integrals_;
};

// Mean body rates between neighbouring frames of motion capture, from their attitudes.
struct MocapRate {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  Eigen::Vector3d body_rates_frd;
};
std::vector<MocapRate> mocap_rates(const VehicleRecording& recording);

// How the stamps of motion capture lie to those of the IMU: positive if they are later. `correlation`: of the sizes of
// both rates at this delay, at most 1.
struct Delay {
  double delay_s = 0.0;
  double correlation = 0.0;
};
Delay find_delay(const GyroTrack& gyro, const std::vector<MocapRate>& mocap, double longest_s);

}  // namespace swiftlet::ground

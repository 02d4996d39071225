// Checks of the streams: that their messages arrive, are valid, and come at their rate with stamps of the vehicle's
// clock.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/stream_statistics.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// How fast the clock of a vehicle runs over that of this computer: 1 unless it is a simulation at another speed, by its
// vehicle_info and its IMU.
double vehicle_rate(const VehicleRecording& recording);

CheckResults check_imu_stream(const VehicleRecording& recording);
// The stream of a vehicle that brings vehicle_odometry in place of imu.
CheckResults check_odometry_stream(const VehicleRecording& recording);

struct StreamLimits {
  const char* topic;
  double least_rate_hz;
  double longest_gap_ms;
  double oldest_ms;    // age of a stamp when it arrives
  const char* absent;  // why it is skipped if nobody publishes it; null: it fails
};
constexpr StreamLimits kBatteryStream{"battery", 5.0, 1000.0, 500.0, nullptr};
constexpr StreamLimits kRotorSpeedStream{"rotor_speeds", 50.0, 100.0, 100.0,
                                         "optional, and nobody publishes it"};
constexpr StreamLimits kMocapStream{"mocap_pose", 30.0, 200.0, 100.0,
                                    "nobody publishes it; start motion capture to check it too"};
constexpr StreamLimits kRequiredMocapStream{kMocapStream.topic, kMocapStream.least_rate_hz,
                                            kMocapStream.longest_gap_ms, kMocapStream.oldest_ms, nullptr};

CheckResults check_stream(const StreamLimits& limits, const TopicState& state, const SampleTimes& samples,
                          const VehicleRecording& recording);
template <class Sample>
CheckResults check_stream(const StreamLimits& limits, const TopicRecord<Sample>& record,
                          const VehicleRecording& recording) {
  return check_stream(limits, record, times_of(record), recording);
}

}  // namespace swiftlet::ground

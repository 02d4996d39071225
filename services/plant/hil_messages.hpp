// From samples of the plant to the messages of a simulator, in MAVLink's units.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/navigation_sensors.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::services {

// fields_updated names the samples that are present; the other fields are 0.
mavlink::HilSensor hil_sensor(std::uint64_t time_usec, const std::optional<plant::ImuSample>& imu,
                              const plant::NavigationSamples& navigation);

// unix_usec: UTC.
mavlink::HilGps hil_gps(std::uint64_t unix_usec, const plant::GpsSample& gps);

// The truth. The acceleration is that of the IMU sample plus gravity, in NED; airspeeds are 0.
mavlink::HilStateQuaternion hil_state(std::uint64_t time_usec, const plant::TruthSample& truth,
                                      const std::optional<plant::ImuSample>& imu,
                                      const plant::SiteSettings& site);

}  // namespace swiftlet::services

// Link of the samples from the vehicle to control: over a radio, each IMU sample travels in a packet with the newest other
// samples.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/links/radio.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

struct TelemetryPacket : SensorSamples {
  ImuSample imu;
  std::optional<OdometrySample> odometry;  // in its place
  ObeyedCommand obeyed;                    // when the sample was taken
};

class TelemetryPath {
 public:
  TelemetryPath(const SimulationSettings& settings, std::uint64_t seed)
      : has_radio_(settings.radio.on()), packets_(settings, seed, streams::kRadioTelemetry) {}

  bool has_radio() const { return has_radio_; }

  // Call after each integration step, and once before the first: collects the samples, and sends them with one of the
  // IMU. obeyed: by the vehicle so far. odometry: that of this IMU sample, if the vehicle brings it in its place.
  void collect(const PlantSimulation& plant, const ObeyedCommand& obeyed,
               const std::optional<OdometrySample>& odometry) {
    for_each_sensor(
        [this](auto& next, const auto& now) {
          if (sent_ || now) next = now;
        },
        next_, plant.samples());
    sent_ = plant.imu().has_value();
    arrived_ = sent_ && !has_radio();
    if (!sent_) return;
    next_.imu = *plant.imu();
    next_.odometry = odometry;
    next_.obeyed = obeyed;
    if (has_radio()) packets_.send(next_, plant.stamp_ns());
  }

  // The next packet that has arrived and was not taken; null if there is none. Valid until the next collect().
  const TelemetryPacket* take(std::int64_t now_ns) {
    if (has_radio()) return packets_.take(now_ns);
    return std::exchange(arrived_, false) ? &next_ : nullptr;
  }

 private:
  bool has_radio_;
  TelemetryPacket next_;
  bool sent_ = false;     // next_, with the last collect()
  bool arrived_ = false;  // next_, without a radio, and was not taken
  RadioLine<TelemetryPacket> packets_;
};

}  // namespace swiftlet::plant

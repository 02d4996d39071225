// A simulated microcontroller and the room that it flies in. Its firmware knows the host only over the port. The room, which
// no real microcontroller has, publishes ground_truth on the network for the simulated motion capture and for recorders.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/microcontroller/firmware.hpp"
#include "swiftlet/services/microcontroller/port.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

// The microcontroller's clock over the time of the room, which is 0 at the start.
struct MicrocontrollerClock {
  double offset_s = 0.0;
  double drift_ppm = 0.0;

  std::int64_t us_at(std::int64_t room_ns) const;
};

struct MicrocontrollerSettings {
  plant::Vehicle vehicle;
  plant::SimulationSettings simulation;
  std::uint64_t seed = 1;
  plant::VehicleState initial;
  MicrocontrollerClock clock;
  double speed = 1.0;  // of the room's time over real time; at another than 1 the host cannot learn the clock
  // While the rotors run, the room stands still until the newest sample is answered, at most this long: for a computer
  // that is too busy for real time. It goes on without answers until one comes.
  double patience_s = 0.0;
  FirmwareSettings firmware;
  runtime::RealtimeSettings realtime;
};

class Microcontroller final : public runtime::HostedVehicle {
 public:
  Microcontroller(const dds::Participant& participant, const std::string& vehicle,
                  const MicrocontrollerSettings& settings, std::unique_ptr<Port> port);

  // In real time, or scaled. If it falls behind by more than an IMU period, the room and with it the microcontroller's clock stand
  // still for that time: a burst of samples could not be answered.
  void run(const std::atomic<bool>& stop) override;
  void attend() override;
  void log_end() override;

 private:
  struct Report {
    bool in_session = false;
    protocol::State state;
    double stood_still_s = 0.0;
  };

  void serve_link();
  void step_to_sample();
  void send_samples();
  void report();
  std::int64_t next_sample_ns() const;  // time of the room
  std::int64_t real_ns(std::int64_t room_ns) const;
  std::int64_t now_us() const;
  bool is_answered() const;  // the newest sample
  bool awaits_answer() const;
  void stand_still(std::int64_t late_ns);

  runtime::RealtimeSettings realtime_;
  MicrocontrollerClock clock_;
  double speed_;
  std::int64_t steps_per_sample_;
  std::int64_t period_ns_;  // of the IMU, time of the room
  std::int64_t patience_ns_;
  bool gave_up_ = false;  // samples are not answered: it no longer waits
  plant::PlantSimulation simulation_;
  std::unique_ptr<Port> port_;
  Firmware firmware_;
  std::array<std::uint8_t, 1024> received_{};
  std::int64_t origin_ns_ = 0;  // monotonic time at which the room's is 0
  std::int64_t stood_still_ns_ = 0;

  dds::Node node_;
  dds::Publisher<messages::msg::GroundTruth> ground_truth_;
  std::uint64_t truths_ = 0;
  runtime::LatestValue<Report> reports_;
  Report last_;
};

}  // namespace swiftlet::services

// A vehicle other than the plant: a mass on a vertical rail with sensors and motion capture that obeys
// actuator commands, or the thrust of attitude setpoints, over the network. It depends on the topics only.
//
// Its time is its own: each sample follows as soon as control has answered the one before, and at the pace of real time while
// control does not answer.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::tests {

class FakeVehicle {
 public:
  // level: actuators or attitude. At actuators it publishes no vehicle_info, so that control assumes that level.
  FakeVehicle(const plant::Vehicle& parameters, const dds::NodeSettings& network,
              plant::ControlLevel level = plant::ControlLevel::kActuators);
  ~FakeVehicle();
  FakeVehicle(const FakeVehicle&) = delete;
  FakeVehicle& operator=(const FakeVehicle&) = delete;

  // Switches for the test.
  std::atomic<bool> seen_by_mocap{true};  // poses are published
  std::atomic<bool> tracked{true};        // poses are valid
  std::atomic<bool> sends_imu{true};
  std::atomic<bool> reports_rotors{true};  // in vehicle_info, when they run

  // Begins anew on the floor with its rotors off, its sequence numbers at 1, while its clock goes on. The commands received before
  // are forgotten.
  void restart();

  // Actuator commands received, in order.
  std::vector<messages::msg::ActuatorCommand> commands() const;
  std::optional<messages::msg::ActuatorCommand> last_command() const;
  double height_m() const { return height_m_; }
  double highest_m() const { return highest_m_; }
  double fastest_rotor() const { return fastest_rotor_; }  // rad/s, since the start
  std::uint64_t samples() const { return imu_sequence_; }

  static constexpr std::int64_t kPeriodNs = 2'000'000;  // of the IMU
  static constexpr double kSupplyV = 3.9;

 private:
  void run();
  void begin_again();
  void wait_for_answer();
  void note_answer(std::uint64_t imu_sequence);  // with mutex_ held
  void move();
  void publish();
  void publish_info();
  bool attitude_commanded() const;  // with rotors running

  const plant::Vehicle parameters_;
  const plant::ControlLevel level_;
  double up_speed_ = 0.0;
  double up_acceleration_ = 0.0;
  double rotor_speed_ = 0.0;
  std::atomic<double> fastest_rotor_{0.0};
  std::atomic<std::int64_t> started_ns_{0};
  std::atomic<bool> restarts_{false};
  std::atomic<double> height_m_{0.0};
  std::atomic<double> highest_m_{0.0};
  std::atomic<std::uint64_t> imu_sequence_{0};
  std::uint64_t mocap_sequence_ = 0;
  std::uint64_t battery_sequence_ = 0;

  mutable std::mutex mutex_;  // guards commands_, attitude_ and answered_
  std::condition_variable answer_;
  std::uint64_t answered_ = 0;  // newest IMU sample that a command answers
  bool is_answered_ = false;    // the last sample
  std::vector<messages::msg::ActuatorCommand> commands_;
  messages::msg::AttitudeSetpoint attitude_;  // the last one received

  dds::Node node_;
  dds::Publisher<messages::msg::Imu> imu_;
  dds::Publisher<messages::msg::MocapPose> mocap_;
  dds::Publisher<messages::msg::Battery> battery_;
  dds::Publisher<messages::msg::VehicleInfo> info_;
  dds::Subscription subscription_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests

// A scripted PX4 on DDS: its commander's rules (rules.hpp), and a simulated vehicle with the loops of a firmware under them. It
// publishes and obeys PX4's topics as PX4 1.16 does through its agent: best effort, at 100 Hz, with stamps in us that lag. The
// ground truth of the vehicle goes to motion capture.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/plant/simulation/firmware/firmware.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/px4/px4_topics.hpp"
#include "tests/support/px4/rules.hpp"

namespace swiftlet::tests {

struct ScriptedPx4Settings {
  int instance = 0;
  double east_m = 0.0;         // where it stands
  double thrust_factor = 1.0;  // thrust over that of the vehicle file
  std::string status_topic = "/out/vehicle_status_v1";
  std::int64_t stamps_lag_us = 40'000;  // of the stamps that go out, after the clock of the agent
};

class ScriptedPx4 {
 public:
  // network.vehicle: whose ground truth is published.
  ScriptedPx4(const plant::Vehicle& vehicle, const comms::NodeSettings& network,
              const ScriptedPx4Settings& settings = {});
  ~ScriptedPx4();
  ScriptedPx4(const ScriptedPx4&) = delete;
  ScriptedPx4& operator=(const ScriptedPx4&) = delete;

  // The link each way.
  std::atomic<bool> sends{true};
  std::atomic<bool> receives{true};

  // Others act.
  void pilot_selects(std::uint8_t nav_state);
  void kill();
  void refuse_to_arm(bool refuse);

  px4_msg::VehicleStatus status() const;
  bool armed() const { return status().arming_state() == 2; }
  double height_m() const { return height_m_; }
  std::vector<px4_msg::VehicleCommand> commands() const;  // received
  std::uint64_t offboard_modes() const { return offboard_modes_; }
  std::uint64_t setpoints() const { return setpoints_; }
  std::uint64_t poses() const { return poses_; }
  std::optional<px4_msg::VehicleOdometry> last_pose() const;
  std::optional<px4_msg::OffboardControlMode> last_mode() const;
  std::optional<px4_msg::TrajectorySetpoint> last_trajectory() const;

 private:
  void subscribe();
  void run();
  void advance();
  plant::VehicleCommand command() const;
  plant::TrajectorySetpoint own_setpoint() const;
  double thrust_n(const std::array<float, 3>& thrust_body) const;
  void take(plant::VehicleCommand setpoint);
  void publish();
  std::uint64_t stamp_us() const;

  const plant::Vehicle vehicle_;
  const ScriptedPx4Settings settings_;
  const plant::SimulationSettings simulation_settings_;
  const px4::Px4Topics topics_;
  const px4::Px4Topic<px4_msg::VehicleStatus> status_topic_;

  mutable std::mutex mutex_;  // guards all down to publishers
  Px4Rules rules_;
  plant::PlantSimulation simulation_;
  plant::Firmware firmware_;
  plant::VehicleCommand setpoint_;
  plant::TrajectorySetpoint own_;  // of PX4's own modes
  std::uint8_t own_mode_ = 0;
  double voltage_v_ = 3.9;
  std::int64_t pose_ns_ = -1;  // when the last came, simulated time
  std::vector<px4_msg::VehicleCommand> commands_;
  std::optional<px4_msg::VehicleOdometry> last_pose_;
  std::optional<px4_msg::OffboardControlMode> last_mode_;
  std::optional<px4_msg::TrajectorySetpoint> last_trajectory_;
  px4_msg::VehicleStatus published_;
  int ticks_ = 0;
  std::atomic<double> height_m_{0.0};
  std::atomic<std::uint64_t> offboard_modes_{0};
  std::atomic<std::uint64_t> setpoints_{0};
  std::atomic<std::uint64_t> poses_{0};

  comms::Node node_;
  comms::Publisher<px4_msg::SensorCombined> sensors_;
  comms::Publisher<px4_msg::VehicleOdometry> odometry_;
  comms::Publisher<px4_msg::BatteryStatus> battery_;
  comms::Publisher<px4_msg::VehicleStatus> status_;
  comms::Publisher<px4_msg::VehicleLandDetected> land_detected_;
  comms::Publisher<px4_msg::FailsafeFlags> flags_;
  comms::Publisher<px4_msg::VehicleCommandAck> acks_;
  comms::Publisher<comms::msg::GroundTruth> truth_;
  std::vector<comms::Subscription> subscriptions_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests

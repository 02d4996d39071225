// A PX4 without its link: its commander's rules (rules.hpp), and a simulated vehicle with the loops of a firmware under them. It
// takes and gives PX4's messages as PX4 1.16 does, 100 times a second, by a clock of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/plant/simulation/firmware/firmware.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/services/px4/px4_topics.hpp"
#include "tests/support/px4/rules.hpp"

namespace swiftlet::tests {

// The messages that PX4 publishes after a period. Stamps are the caller's.
struct Px4Messages {
  std::optional<px4_msg::SensorCombined> sensors;
  px4_msg::VehicleOdometry odometry;
  std::optional<px4_msg::BatteryStatus> battery;
  bool has_status = false;  // and flags and land_detected
  px4_msg::VehicleStatus status;
  px4_msg::FailsafeFlags flags;
  px4_msg::VehicleLandDetected land_detected;
};

// Not thread-safe.
class Px4Simulation {
 public:
  static constexpr std::int64_t kPeriodNs = 10'000'000;
  // It stamps the odometry of every other period as published so much later than the sample that it is of, us.
  static constexpr std::uint64_t kLatePublicationUs = 5'000;

  // thrust_factor: thrust over that of the vehicle file. east_m: where it stands.
  explicit Px4Simulation(const plant::Vehicle& vehicle, double thrust_factor = 1.0, double east_m = 0.0);

  void on_offboard_mode(const px4_msg::OffboardControlMode& mode);
  std::optional<px4_msg::VehicleCommandAck> on_command(const px4_msg::VehicleCommand& command);
  void on_setpoint(const px4_msg::VehicleRatesSetpoint& setpoint);
  void on_setpoint(const px4_msg::VehicleAttitudeSetpoint& setpoint);
  void on_setpoint(const px4_msg::TrajectorySetpoint& setpoint);
  void on_pose(const px4_msg::VehicleOdometry& pose);

  // Makes the steps of a period. stamp_us: of the messages.
  Px4Messages advance(std::uint64_t stamp_us);

  // Others act.
  void pilot_selects(std::uint8_t nav_state) { rules_.pilot_selects(nav_state, now_us()); }
  void kill() { rules_.kill(now_us()); }
  void refuse_to_arm(bool refuse) { rules_.refuses_to_arm = refuse; }

  const Px4Rules& rules() const { return rules_; }
  const px4_msg::VehicleStatus& status() const { return rules_.status(); }
  plant::TruthSample truth() const { return simulation_.truth(); }
  double height_m() const { return -simulation_.state().position_ned.z(); }
  // Received.
  const std::vector<px4_msg::VehicleCommand>& commands() const { return commands_; }
  std::uint64_t offboard_modes() const { return offboard_modes_; }
  std::uint64_t setpoints() const { return setpoints_; }
  std::uint64_t poses() const { return poses_; }
  const std::optional<px4_msg::VehicleOdometry>& last_pose() const { return last_pose_; }
  const std::optional<px4_msg::OffboardControlMode>& last_mode() const { return last_mode_; }

 private:
  std::int64_t now_us() const { return simulation_.stamp_ns() / 1000; }
  void step();
  Px4Messages messages(std::uint64_t stamp_us);
  plant::VehicleCommand command() const;
  plant::TrajectorySetpoint own_setpoint() const;
  double thrust_n(const std::array<float, 3>& thrust_body) const;
  void take(plant::VehicleCommand setpoint);

  const plant::Vehicle vehicle_;
  const double thrust_factor_;
  const plant::SimulationSettings simulation_settings_;
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
  px4_msg::VehicleStatus published_;
  int ticks_ = 0;
  std::uint64_t offboard_modes_ = 0;
  std::uint64_t setpoints_ = 0;
  std::uint64_t poses_ = 0;
};

}  // namespace swiftlet::tests

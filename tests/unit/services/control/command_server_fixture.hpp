// A controller without DDS: its command server, its inner loop, and the samples of a vehicle at rest, or of one whose poses follow
// the reference.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/control/command_server.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::services {

namespace msg = messages::msg;
namespace Command_Constants = messages::msg::Command_Constants;

constexpr std::uint64_t kClient = 77;

class CommandServerTest : public testing::Test {
 protected:
  CommandServerTest()
      : vehicle_(io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"))),
        settings_(io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"))),
        loop_(vehicle_, settings_),
        command_server_(loop_, vehicle_, settings_, GainDesigner(vehicle_, settings_), wake_) {}

  // One IMU, battery and rotor speed sample, and a pose with every fifth.
  plant::ActuatorCommand step() {
    ++sequence_;
    const auto stamp = static_cast<std::int64_t>(sequence_) * 2'000'000;
    if (sequence_ % 5 == 1) {
      if (follows_reference_) {
        take_snapshots();
        last_pose_.position_ned = last_.reference.position_ned;
      }
      last_pose_.stamp_ns = stamp;
      last_pose_.sequence = sequence_;
      last_pose_.tracked = true;
      loop_.pose.put(last_pose_);
    }
    last_battery_ = {stamp, sequence_, 4.0, 0.1, 0.9};
    loop_.battery.put(last_battery_);
    last_rotor_speeds_.stamp_ns = stamp;
    last_rotor_speeds_.sequence = sequence_;
    last_rotor_speeds_.rotor_count = vehicle_.rotor_count();
    loop_.rotor_speeds.put(last_rotor_speeds_);
    last_imu_.stamp_ns = stamp;
    last_imu_.sequence = sequence_;
    last_imu_.specific_force_frd = {0.0, 0.0, -plant::kGravity};
    const auto command = std::get<plant::ActuatorCommand>(loop_.step(last_imu_, 1'000'000'000 + stamp));
    loop_.finish(1'000'000'000 + stamp + 20'000);
    return command;
  }
  void settle() {
    for (int i = 0; i < 500; ++i) step();
    take_snapshots();
  }
  void take_snapshots() {
    Snapshot snapshot;
    while (loop_.snapshots.pop(snapshot)) last_ = snapshot;
  }
  control::Mode mode() {
    step();
    take_snapshots();
    return last_.status.mode;
  }

  static msg::Command command(std::uint8_t kind, std::uint64_t id) {
    msg::Command message;
    message.client(kClient);
    message.id(id);
    message.kind(kind);
    message.speed(0.5);
    message.position_ned({0.0, 0.0, -1.0});
    return message;
  }
  static msg::Mission mission(std::uint64_t id, double x) {
    control::Mission mission;
    mission.id = id;
    mission.items.push_back({control::MissionItemKind::kTakeoff, {0.0, 0.0, -1.0}, 0.0, true, 0.5, 0.0});
    mission.items.push_back({control::MissionItemKind::kWaypoint, {x, 0.0, -1.0}, 0.0, true, 0.5, 0.0});
    mission.items.push_back({control::MissionItemKind::kLand, {0.0, 0.0, 0.0}, 0.0, true, 0.5, 0.0});
    msg::Mission message = messages::to_message(mission);
    message.client(kClient);
    return message;
  }

  // The settings of the controller with another bandwidth of x.
  msg::ControlSettings settings_message(std::uint64_t id, double omega_n, double zeta = 1.0) const {
    control::ControlSettings settings = settings_;
    settings.name = "soft";
    settings.position.x.omega_n = omega_n;
    settings.position.x.zeta = zeta;
    msg::ControlSettings message = messages::to_message(control::settings_request(settings, {}, 1.0));
    message.client(kClient);
    message.id(id);
    return message;
  }

  plant::Vehicle vehicle_;
  control::ControlSettings settings_;
  Semaphore wake_;
  InnerLoop loop_;
  CommandServer command_server_;
  std::uint64_t sequence_ = 0;
  bool follows_reference_ = false;
  plant::PoseSample last_pose_;
  plant::BatterySample last_battery_;
  plant::RotorSpeedSample last_rotor_speeds_;
  plant::ImuSample last_imu_;
  Snapshot last_;
};

}  // namespace swiftlet::services

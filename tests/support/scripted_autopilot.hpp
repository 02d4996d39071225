// An autopilot at the far end of swiftlet-plant --autopilot mavlink, which keeps the order of messages of PX4's
// simulator interface:
//
// - connects to the simulator, requests HIL_STATE_QUATERNION and sends a HEARTBEAT;
// - its clock is the time of the newest HIL_SENSOR;
// - answers each HIL_SENSOR with HIL_ACTUATOR_CONTROLS of that time, with the flag of lockstep if so configured;
// - arms after some time at rest.
//
// It hovers by a cascade of position, attitude and rate loops: rates are those of HIL_SENSOR, the rest is that of
// HIL_STATE_QUATERNION.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/io/mavlink/frame_parser.hpp"
#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/io/mavlink/payload.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::tests {

struct ScriptedAutopilotSettings {
  bool lockstep = true;
  std::uint8_t system_id = 1;
  double arms_at_s = 0.2;          // by its clock
  double height_m = 0.5;           // of the hover above the origin
  std::uint64_t period_us = 2000;  // of HIL_SENSOR, to check
  int samples_per_answer = 1;      // it leaves the others without an answer
};

// The messages that the autopilot received.
struct AutopilotLog {
  std::vector<std::uint64_t> sensor_times_us;
  std::uint64_t irregular = 0;  // HIL_SENSOR that do not follow the last by one period
  int imus = 0, barometers = 0, magnetometers = 0, gps = 0, states = 0, heartbeats = 0, times = 0;
  mavlink::HilSensor first_barometer;  // and magnetic field
  mavlink::HilGps first_gps;
  std::vector<std::uint8_t> bytes;  // all of them
  double height_m = 0.0;            // newest
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
  std::vector<double> answer_times_us;  // from HIL_SENSOR received to HIL_ACTUATOR_CONTROLS sent
};

class ScriptedAutopilot {
 public:
  ScriptedAutopilot(const plant::Vehicle& vehicle, const plant::SiteSettings& site,
                    const ScriptedAutopilotSettings& settings);
  ~ScriptedAutopilot();
  ScriptedAutopilot(const ScriptedAutopilot&) = delete;
  ScriptedAutopilot& operator=(const ScriptedAutopilot&) = delete;

  // Connects as soon as the simulator listens. Returns false after the timeout.
  bool connect(int port, std::chrono::milliseconds timeout);
  // Uses an open descriptor, which it then owns, in place of a connection.
  void use(int descriptor);
  void disconnect();

  // Flies until its clock shows this time. Returns false if the connection ends before, or if no HIL_SENSOR comes
  // for the timeout.
  bool fly_until(double time_s, std::chrono::milliseconds timeout);

  // Sends bytes as they are between its messages.
  void send(const std::vector<std::uint8_t>& bytes);
  template <class Message>
  void send_message(const Message& message, std::uint8_t system_id) {
    const mavlink::FrameBytes bytes =
        mavlink::encode(mavlink::to_frame(message, {system_id, 1}, sequence_++), Message::kCrcExtra);
    send({bytes.data.begin(), bytes.data.begin() + static_cast<std::ptrdiff_t>(bytes.size)});
  }

  const AutopilotLog& log() const { return log_; }

 private:
  void introduce();
  void on_frame(const mavlink::Frame& frame);
  void on_sensor(const mavlink::HilSensor& sensor);
  void on_state(const mavlink::HilStateQuaternion& state);
  mavlink::HilActuatorControls controls(const mavlink::HilSensor& sensor);
  plant::RotorThrusts thrusts(const Eigen::Vector3d& body_rates);

  const plant::Vehicle vehicle_;
  const plant::SiteSettings site_;
  const ScriptedAutopilotSettings settings_;
  const plant::Allocation allocation_;
  int descriptor_ = -1;
  std::uint8_t sequence_ = 0;
  mavlink::FrameParser parser_;
  AutopilotLog log_;
  std::uint64_t time_us_ = 0;
  mavlink::HilStateQuaternion state_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();  // of the position error, m s
};

// A TCP port of the loopback interface that is free now.
int free_tcp_port();

}  // namespace swiftlet::tests

#include "tests/support/separate_processes.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::tests {
namespace {

namespace msg = ground::msg;
using ground::View;

}  // namespace

SeparateProcesses::SeparateProcesses()
    : client_(std::make_shared<ground::Client>(node("ground"))),
      watcher_(std::make_unique<dds::Node>(node("watcher"))),
      telemetry_(std::make_unique<TelemetryLog>(*watcher_)) {
  status_ =
      watcher_->subscribe<msg::ControlStatus>(messages::topics::kControlStatus, [this](const auto& status) {
        mode_log_.put(std::string(ground::mode_name(status.mode())) + ": " + status.reason().c_str());
      });
}

dds::NodeSettings SeparateProcesses::node(const std::string& name) const {
  dds::NodeSettings settings;
  settings.name = name;
  settings.domain = lock_.domain();
  return settings;
}

std::unique_ptr<Program> SeparateProcesses::start(const std::string& program,
                                                  std::vector<std::string> arguments) const {
  arguments.insert(arguments.end(), {"--domain", std::to_string(lock_.domain()), "--localhost-only"});
  return std::make_unique<Program>(program, std::move(arguments), folder_.path());
}

void SeparateProcesses::start_all(const std::vector<std::string>& control_arguments,
                                  const std::vector<std::string>& plant_arguments, const std::string& speed) {
  control_ = start("swiftlet-control", control_arguments);
  mocap_ = start("swiftlet-mocap", mocap_in_simulated_time());
  plant_ = start("swiftlet-plant", plant_in_simulated_time(plant_arguments, speed));
}

void SeparateProcesses::start_all_in_real_time() {
  control_ = start("swiftlet-control");
  mocap_ = start("swiftlet-mocap");
  plant_ = start("swiftlet-plant");
}

void SeparateProcesses::wait_until_ready() {
  ASSERT_TRUE(client_->wait(kTimeout, [](const View& view) {
    return view.control.message.has_pose() && view.truth.seen() && view.battery.seen();
  })) << control_->errors();
}

void SeparateProcesses::hover() {
  wait_until_ready();
  ground::Result armed;
  ASSERT_TRUE(eventually([&] { return (armed = ask(control::RequestKind::kArm)).accepted(); }, kTimeout))
      << armed.reason;
  clear_history();
  const auto start = client_->view().truth.message.position_ned();
  const ground::Result off = ask(control::RequestKind::kTakeoff);
  ASSERT_TRUE(off.accepted()) << off.reason;
  ASSERT_TRUE(reported(control::Mode::kHolding, "take-off completed")) << mode_log() << control_->errors();
  const bool arrived = eventually([&] { return distance_m(start[0], start[1], -1) < 0.05; }, kTimeout);
  const auto end = client_->view().truth.message.position_ned();
  ASSERT_TRUE(arrived) << "at " << end[0] << " " << end[1] << " " << end[2] << " m, from " << start[0] << " "
                       << start[1] << " m\n"
                       << mode_log() << plant_->errors() << control_->errors();
  clear_history();
  ASSERT_TRUE(reported(control::Mode::kHolding, "take-off completed"))
      << "status must continue after clear_history()";
}

ground::Result SeparateProcesses::ask(control::RequestKind kind, double z_ned) {
  control::Request request;
  request.kind = kind;
  request.position_ned.z() = z_ned;
  request.speed = 0.8;
  return client_->request(request, std::chrono::seconds(5));
}

bool SeparateProcesses::reported(control::Mode mode, const std::string& reason,
                                 std::chrono::milliseconds timeout) {
  const std::string wanted = std::string(control::to_string(mode)) + ": " + reason;
  return mode_log_.wait(
      [&](const auto& reported) {
        return std::find(reported.begin(), reported.end(), wanted) != reported.end();
      },
      timeout);
}

void SeparateProcesses::clear_history() {
  mode_log_.clear();
  telemetry_->clear();
}

std::string SeparateProcesses::mode_log() const {
  std::string text;
  std::string last;
  for (const std::string& line : mode_log_.items()) {
    if (line != last) text += line + "\n";
    last = line;
  }
  return text;
}

bool SeparateProcesses::wait_for_truth(const std::function<bool(const msg::GroundTruth&)>& predicate,
                                       std::chrono::milliseconds timeout) const {
  return client_->wait(timeout, [&](const View& view) { return predicate(view.truth.message); });
}

void SeparateProcesses::wait_vehicle_time(double seconds) const {
  const std::int64_t end_ns = stamp_ns() + std::llround(seconds * 1e9);
  ASSERT_TRUE(wait_for_truth([&](const auto& truth) { return truth.stamp_ns() >= end_ns; }));
}

bool SeparateProcesses::wait_until_rotors_off() const {
  return client_->wait(kTimeout, [](const View& view) { return !view.vehicle.message.rotors_running(); });
}

bool SeparateProcesses::wait_until_on_ground() const {
  return wait_for_truth([](const auto& truth) { return truth.on_ground(); });
}

double SeparateProcesses::distance_m(double x, double y, double z) const {
  const auto at = client_->view().truth.message.position_ned();
  return std::hypot(at[0] - x, at[1] - y, at[2] - z);
}

double tilt_rad(const record::TruthRow& row) {
  const auto& q = row.q_ned_from_frd;
  return std::acos(std::clamp(1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]), -1.0, 1.0));
}

double fastest_rotor(const record::TruthRow& row) {
  return *std::max_element(row.rotor_speeds.begin(), row.rotor_speeds.end());
}

}  // namespace swiftlet::tests

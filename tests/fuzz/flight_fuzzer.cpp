// Fuzzes the controller in closed loop with requests, setpoints, poses, battery samples and heartbeats in any
// order. Each byte of the input is an operation or an argument of one.
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/support/paths.hpp"

using namespace swiftlet;

namespace {

constexpr double kLongest_s = 10.0;  // of a flight

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}
  bool empty() const { return next_ == end_; }
  std::uint8_t byte() { return empty() ? 0 : *next_++; }
  // -5 to 5 in steps of 0.04, or an extreme value.
  double number() {
    const std::uint8_t tag = byte();
    switch (tag) {
      case 251:
        return raw();
      case 252:
        return std::numeric_limits<double>::quiet_NaN();
      case 253:
        return std::numeric_limits<double>::infinity();
      case 254:
        return -1e300;
      case 255:
        return 1e-300;
      default:
        return (tag - 125) * 0.04;
    }
  }
  Eigen::Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

 private:
  double raw() {
    std::uint8_t bytes[8] = {};
    for (std::uint8_t& one : bytes) one = byte();
    double value = 0.0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  const std::uint8_t* next_;
  const std::uint8_t* end_;
};

const plant::Vehicle& vehicle() {
  static const auto read = io::load_vehicle(swiftlet::tests::in_source("config/vehicles/kaylion.yaml"));
  return read;
}
const plant::SimulationSettings& simulation() {
  static const auto read =
      io::load_simulation_settings(swiftlet::tests::in_source("config/simulation/default.yaml"));
  return read;
}
const control::ControlSettings& settings() {
  static const auto read =
      io::load_control_settings(swiftlet::tests::in_source("config/control/motor_lag.yaml"));
  return read;
}

class Flight {
 public:
  explicit Flight(Input input) : input_(input), loop_(vehicle(), simulation(), settings(), 1) {}

  void fly() {
    step(500);
    while (!input_.empty() && loop_.time_s() < kLongest_s) act();
    step(100);
  }

 private:
  void act() {
    using Kind = control::RequestKind;
    switch (input_.byte() % 21) {
      case 0:
        return ask(Kind::kArm);
      case 1:
        return ask(Kind::kDisarm);
      case 2:
        return ask(Kind::kTakeoff);
      case 3:
        return ask(Kind::kGoTo);
      case 4:
        return ask(Kind::kHold);
      case 5:
        return ask(Kind::kLand);
      case 6:
        return ask(Kind::kStop);
      case 7:
        return fly_mission();
      case 8:
        return fly_trajectory();
      case 9:
        return send_setpoint();
      case 10:
        return send_pose();
      case 11:
        return send_battery();
      case 12:
        return send_heartbeat();
      case 13:
        return step(input_.byte());
      default:
        return step(5 * input_.byte());
    }
  }

  void step(int steps) {
    for (int i = 0; i < steps && loop_.time_s() < kLongest_s; ++i) {
      loop_.step();
      for (int rotor = 0; rotor < loop_.command.rotor_count; ++rotor) {
        const double throttle = loop_.command.throttle[static_cast<std::size_t>(rotor)];
        tests::demand(throttle >= 0.0 && throttle <= 1.0, "a throttle is between 0 and 1");
      }
      const control::Estimate& estimate = loop_.controller.estimate();
      tests::demand(estimate.position_ned.allFinite() && estimate.velocity_ned.allFinite() &&
                        estimate.q_ned_from_frd.coeffs().allFinite(),
                    "the estimate is finite");
      const control::Reference& reference = loop_.controller.reference();
      tests::demand(reference.position_ned.allFinite() && reference.velocity_ned.allFinite() &&
                        reference.acceleration_ned.allFinite() && std::isfinite(reference.yaw_rad),
                    "the reference is finite");
    }
  }

  bool answer(const control::Request& request) {
    const control::Outcome outcome = loop_.controller.request(request);
    tests::demand(outcome.accepted || std::strlen(outcome.reason) > 4, "a refusal says why");
    return outcome.accepted;
  }

  void ask(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    if (kind == control::RequestKind::kTakeoff || kind == control::RequestKind::kGoTo) {
      request.position_ned = input_.vector();
      request.speed = input_.number();
      request.yaw_rad = input_.number();
      request.yaw_free = input_.byte() % 2 == 0;
    }
    answer(request);
  }

  void fly_mission() {
    control::Mission mission;
    mission.id = input_.byte();
    const int items = input_.byte() % 8;
    for (int i = 0; i < items; ++i) {
      control::MissionItem& item = mission.items.emplace_back();
      item.kind = static_cast<control::MissionItemKind>(input_.byte() % 5);
      item.position_ned = input_.vector();
      item.speed = input_.number();
      item.hold_s = input_.number();
      item.yaw_rad = input_.number();
      item.yaw_free = input_.byte() % 2 == 0;
      item.first_segment = input_.byte() % 4;
      item.segment_count = input_.byte() % 4;
      item.acceptance_radius_m = input_.number();
    }
    mission.segments = segments();
    if (!control::check(mission, settings().limits).accepted) return;
    control::Request request;
    request.kind = control::RequestKind::kMissionUpload;
    request.mission = &missions_.emplace_back(std::move(mission));
    if (answer(request)) ask(control::RequestKind::kMissionStart);
  }

  void fly_trajectory() {
    control::Trajectory trajectory{input_.byte(), segments()};
    if (!control::check(trajectory, settings().limits).accepted) return;
    control::Request request;
    request.kind = control::RequestKind::kTrajectory;
    request.trajectory = &trajectories_.emplace_back(std::move(trajectory));
    answer(request);
  }

  std::vector<control::PolynomialSegment> segments() {
    std::vector<control::PolynomialSegment> out(input_.byte() % 4);
    for (control::PolynomialSegment& segment : out) {
      segment.duration_s = input_.number();
      for (auto* const axis : {&segment.x, &segment.y, &segment.z, &segment.yaw}) {
        const int count = input_.byte() % 9;
        for (int i = 0; i < count; ++i) (*axis)[static_cast<std::size_t>(i)] = input_.number();
      }
    }
    return out;
  }

  void send_setpoint() {
    control::Setpoint setpoint;
    setpoint.stamp_ns = loop_.plant.stamp_ns();
    setpoint.sequence = ++sequence_;
    setpoint.kind = static_cast<control::SetpointKind>(input_.byte() % 6);  // one invalid kind
    setpoint.position_ned = input_.vector();
    setpoint.velocity_ned = input_.vector();
    setpoint.acceleration_ned = input_.vector();
    setpoint.yaw_rad = input_.number();
    setpoint.yaw_rate = input_.number();
    setpoint.yaw_free = input_.byte() % 2 == 0;
    setpoint.q_ned_from_frd = attitude();
    setpoint.body_rates_frd = input_.vector();
    setpoint.specific_thrust = input_.number();
    const control::Outcome outcome = loop_.controller.on_setpoint(setpoint);
    tests::demand(outcome.accepted || std::strlen(outcome.reason) > 4, "a refusal says why");
  }

  // A pose that passes the message checks but need not be true.
  void send_pose() {
    plant::PoseSample pose;
    pose.stamp_ns = loop_.plant.stamp_ns() - std::int64_t{1'000'000} * input_.byte();
    pose.sequence = ++sequence_;
    pose.tracked = input_.byte() % 8 != 0;
    pose.position_ned = input_.vector();
    pose.q_ned_from_frd = attitude();
    if (pose.position_ned.allFinite()) loop_.controller.on_pose(pose);
  }

  // An attitude of unit length, as in an accepted message.
  Eigen::Quaterniond attitude() {
    const Eigen::Vector3d axis = input_.vector();
    const Eigen::Vector4d wxyz(input_.number(), axis.x(), axis.y(), axis.z());
    const double norm = wxyz.norm();
    if (!(norm > 1e-100 && norm < 1e100)) return Eigen::Quaterniond::Identity();
    return {wxyz[0] / norm, wxyz[1] / norm, wxyz[2] / norm, wxyz[3] / norm};
  }

  void send_battery() {
    plant::BatterySample battery;
    battery.stamp_ns = loop_.plant.stamp_ns();
    battery.sequence = ++sequence_;
    battery.voltage_v = std::abs(input_.number());
    if (std::isfinite(battery.voltage_v)) loop_.controller.on_battery(battery);
  }

  void send_heartbeat() {
    loop_.controller.on_ground_heartbeat({1u + input_.byte() % 20u, input_.byte() % 2 == 0});
  }

  Input input_;
  simulation::ClosedLoop loop_;
  std::uint64_t sequence_ = 1'000'000;
  std::deque<control::Mission> missions_;  // the controller may still fly any of them
  std::deque<control::Trajectory> trajectories_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Flight(Input(data, size)).fly();
  return 0;
}

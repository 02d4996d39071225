#include "swiftlet/ground/mission/dry_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/control/supervision/supervisor.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {
namespace {

using control::MissionState;

constexpr double kStep_s = 0.002;         // at most half the shortest segment, so that none is missed, ...
constexpr double kLeastStep_s = 0.0001;   // ... but at least this
constexpr double kFullBattery_v = 100.0;  // above all thresholds: the dry run does not check the battery
constexpr double kSpare_s = 60.0;         // time limit: this plus twice the planned duration

class Run {
 public:
  Run(const control::Mission& mission, const control::ControlSettings& settings,
      const Eigen::Vector2d& start_ned)
      : mission_(mission), supervisor_({settings.limits, settings.arming, settings.failsafe}) {
    mission_.id = 1;
    double step_s = kStep_s;
    for (const control::PolynomialSegment& segment : mission_.segments)
      step_s = std::min(step_s, 0.5 * segment.duration_s);
    step_ns_ = std::llround(std::max(step_s, kLeastStep_s) * 1e9);
    inputs_.estimate = &estimate_;
    inputs_.has_estimate = true;
    inputs_.has_battery = true;
    inputs_.supply_voltage_v = kFullBattery_v;
    inputs_.specific_force_frd.z() = -plant::kGravity;
    estimate_.position_ned.head<2>() = start_ned;
    end_s_ = 2.0 * planned_duration_s(mission, settings.limits) + kSpare_s;
    step();
  }

  MissionDryRun fly() {
    if (begin()) {
      start_ns_ = inputs_.stamp_ns;
      while (supervisor_.mission().state == MissionState::kRunning && elapsed_s() < end_s_) {
        record_leg();
        step();
      }
      end();
    }
    return std::move(out_);
  }

 private:
  bool begin() {
    const bool from_ground = mission_.items.front().kind == control::MissionItemKind::kTakeoff;
    if (!from_ground) estimate_.position_ned.z() = -kDryRunHover_m;
    control::Request upload;
    upload.kind = control::RequestKind::kMissionUpload;
    upload.mission = &mission_;
    return accepted(from_ground ? ask(control::RequestKind::kArm) : supervisor_.engage_in_flight(inputs_)) &&
           accepted(supervisor_.request(upload, inputs_)) &&
           accepted(ask(control::RequestKind::kMissionStart));
  }

  control::Outcome ask(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    return supervisor_.request(request, inputs_);
  }

  bool accepted(const control::Outcome& outcome) {
    if (!outcome.accepted) out_.reason = outcome.reason;
    return outcome.accepted;
  }

  double elapsed_s() const { return static_cast<double>(inputs_.stamp_ns - start_ns_) * 1e-9; }

  void step() {
    inputs_.stamp_ns += step_ns_;
    estimate_.stamp_ns = inputs_.stamp_ns;
    const control::ControlSetpoint setpoint = supervisor_.step(inputs_);
    if (setpoint.control_mode != control::ControlMode::kFly) return;
    estimate_.position_ned = setpoint.reference.position_ned;
    estimate_.velocity_ned = setpoint.reference.velocity_ned;
    if (estimate_.position_ned.z() < 0.0) return;
    estimate_.position_ned.z() = 0.0;  // the ground
    estimate_.velocity_ned.setZero();
  }

  // Records the item and the leg being flown if they are new.
  void record_leg() {
    const control::SupervisorState& state = supervisor_.state();
    const auto item = static_cast<std::size_t>(state.guidance.mission.item_index);
    while (out_.item_starts_s.size() <= item) out_.item_starts_s.push_back(elapsed_s());
    const control::ReferencePath& path = state.guidance.path;
    if (!path.moving || path.start_ns == leg_ns_ || state.guidance.phase != control::Phase::kPath) return;
    leg_ns_ = path.start_ns;
    out_.legs.push_back({path.segment, static_cast<double>(path.start_ns - start_ns_) * 1e-9, item});
  }

  void end() {
    out_.duration_s = elapsed_s();
    out_.completed = supervisor_.mission().state == MissionState::kCompleted;
    if (out_.completed) return;
    out_.reason = supervisor_.mission().state == MissionState::kRunning
                      ? "the mission does not end within its time limit"
                      : std::string("the mission is aborted: ") + control::to_string(supervisor_.reason());
  }

  control::Mission mission_;
  control::Supervisor supervisor_;
  control::Estimate estimate_;
  control::SupervisorInputs inputs_;
  MissionDryRun out_;
  std::int64_t start_ns_ = 0;
  std::int64_t leg_ns_ = -1;
  std::int64_t step_ns_ = 0;
  double end_s_ = 0.0;
};

}  // namespace

MissionDryRun dry_run(const control::Mission& mission, const control::ControlSettings& settings,
                      const Eigen::Vector2d& start_ned) {
  return Run(mission, settings, start_ned).fly();
}

}  // namespace swiftlet::ground

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

constexpr double kStep_s = 0.002;         // so that no segment is missed, half the shortest, ...
constexpr double kLeastStep_s = 0.0001;   // ... but no less
constexpr double kFullBattery_v = 100.0;  // above all thresholds: whether it lasts is not rehearsed
constexpr double kSpare_s = 60.0;         // beyond twice the planned duration, after which it is given up

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
    situation_.estimate = &estimate_;
    situation_.has_estimate = true;
    situation_.has_battery = true;
    situation_.supply_voltage_v = kFullBattery_v;
    situation_.specific_force_frd.z() = -plant::kGravity;
    estimate_.position_ned.head<2>() = start_ned;
    end_s_ = 2.0 * planned_duration_s(mission, settings.limits) + kSpare_s;
    step();
  }

  MissionDryRun fly() {
    if (begin()) {
      start_ns_ = situation_.stamp_ns;
      while (supervisor_.mission().state == MissionState::kRunning && elapsed_s() < end_s_) {
        note();
        step();
      }
      end();
    }
    return std::move(out_);
  }

 private:
  bool begin() {
    const bool from_ground = mission_.items.front().kind == control::MissionItemKind::kTakeoff;
    if (!from_ground) estimate_.position_ned.z() = -kRehearsedHover_m;
    control::Request upload;
    upload.kind = control::RequestKind::kMissionUpload;
    upload.mission = &mission_;
    return demand(from_ground ? ask(control::RequestKind::kArm) : supervisor_.engage_in_flight(situation_)) &&
           demand(supervisor_.request(upload, situation_)) &&
           demand(ask(control::RequestKind::kMissionStart));
  }

  control::Outcome ask(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    return supervisor_.request(request, situation_);
  }

  bool demand(const control::Outcome& outcome) {
    if (!outcome.accepted) out_.reason = outcome.reason;
    return outcome.accepted;
  }

  double elapsed_s() const { return static_cast<double>(situation_.stamp_ns - start_ns_) * 1e-9; }

  void step() {
    situation_.stamp_ns += step_ns_;
    estimate_.stamp_ns = situation_.stamp_ns;
    const control::ControlSetpoint directive = supervisor_.step(situation_);
    if (directive.control_mode != control::ControlMode::kFly) return;
    estimate_.position_ned = directive.reference.position_ned;
    estimate_.velocity_ned = directive.reference.velocity_ned;
    if (estimate_.position_ned.z() < 0.0) return;
    estimate_.position_ned.z() = 0.0;  // the ground
    estimate_.velocity_ned.setZero();
  }

  // The item and the leg that are flown from now on, if they are new.
  void note() {
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
                      ? "it does not come to its end"
                      : std::string("it is aborted: ") + control::to_string(supervisor_.reason());
  }

  control::Mission mission_;
  control::Supervisor supervisor_;
  control::Estimate estimate_;
  control::SupervisorInputs situation_;
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

#include "swiftlet/ground/mission/dry_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/control/supervision/supervisor.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/simulation/mission_runner.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kLongestStep_s = 0.002;  // at most half the shortest segment, so that none is missed, ...
constexpr double kLeastStep_s = 0.0001;   // ... but at least this
constexpr double kPatience = 100.0;       // planned durations until it is taken to be endless
constexpr double kFullBattery_v = 100.0;  // above all thresholds: the dry run does not check the battery

// Supervision and guidance alone, with a vehicle that is exactly where its reference is.
class DryRunTransport final : public simulation::MissionTransport {
 public:
  DryRunTransport(const control::Mission& mission, const control::ControlSettings& settings,
                  const Eigen::Vector2d& start_ned)
      : mission_(mission), supervisor_({settings.limits, settings.arming, settings.failsafe}) {
    mission_.id = 1;
    double step_s = kLongestStep_s;
    for (const control::PolynomialSegment& segment : mission_.segments)
      step_s = std::min(step_s, 0.5 * segment.duration_s);
    step_ns_ = std::llround(std::max(step_s, kLeastStep_s) * 1e9);
    inputs_.estimate = &estimate_;
    inputs_.has_estimate = true;
    inputs_.has_battery = true;
    inputs_.supply_voltage_v = kFullBattery_v;
    inputs_.specific_force_frd.z() = -plant::kGravity;
    estimate_.position_ned.head<2>() = start_ned;
  }

  void wait_until_ready() override {
    step();
    if (!takes_off()) estimate_.position_ned.z() = -kDryRunHover_m;
  }
  Reply arm() override {
    return reply(takes_off() ? request(control::RequestKind::kArm) : supervisor_.engage_in_flight(inputs_));
  }
  void wait(std::int64_t, const std::string& reason) override { throw simulation::FlightFailure(reason); }
  Reply start_mission() override {
    const control::Outcome uploaded = request(control::RequestKind::kMissionUpload);
    start_ns_ = inputs_.stamp_ns;
    return reply(uploaded.accepted ? request(control::RequestKind::kMissionStart) : uploaded);
  }
  void advance() override {
    record_leg();
    step();
    out_.duration_s = elapsed_s();
  }
  // The dry run ends with the mission.
  Status status() const override { return {inputs_.stamp_ns, supervisor_.mission().state, true}; }
  std::string abort_reason() const override { return control::to_string(supervisor_.reason()); }

  MissionDryRun result() && { return std::move(out_); }

 private:
  static Reply reply(const control::Outcome& outcome) { return {outcome.accepted, false, outcome.reason}; }

  bool takes_off() const { return mission_.items.front().kind == control::MissionItemKind::kTakeoff; }

  control::Outcome request(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    if (kind == control::RequestKind::kMissionUpload) request.mission = &mission_;
    return supervisor_.request(request, inputs_);
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

  control::Mission mission_;
  control::Supervisor supervisor_;
  control::Estimate estimate_;
  control::SupervisorInputs inputs_;
  MissionDryRun out_;
  std::int64_t start_ns_ = 0;
  std::int64_t leg_ns_ = -1;
  std::int64_t step_ns_ = 0;
};

}  // namespace

MissionDryRun dry_run(const control::Mission& mission, const control::ControlSettings& settings,
                      const Eigen::Vector2d& start_ned) {
  DryRunTransport transport(mission, settings, start_ned);
  std::string reason;
  try {
    simulation::fly_mission(transport, kPatience * io::planned_duration_s(mission, settings.limits));
  } catch (const simulation::FlightFailure& failure) {
    reason = failure.what();
  }
  MissionDryRun out = std::move(transport).result();
  out.completed = reason.empty();
  out.reason = reason;
  return out;
}

}  // namespace swiftlet::ground

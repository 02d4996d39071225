#include "swiftlet/simulation/simulated_flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/telemetry_rate.hpp"
#include "swiftlet/simulation/mission_runner.hpp"

namespace swiftlet::simulation {
namespace {

std::array<double, 3> array(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

record::TruthRow row_of(const plant::TruthSample& truth) {
  const Eigen::Quaterniond& q = truth.q_ned_from_frd;
  return {truth.stamp_ns,
          array(truth.position_ned),
          array(truth.velocity_ned),
          {q.w(), q.x(), q.y(), q.z()},
          array(truth.body_rates_frd),
          truth.rotor_speeds,
          truth.rotor_count,
          truth.supply_voltage_v,
          truth.on_ground};
}

// A loop in this process. All requests are made between an answered IMU sample and the next.
class LoopTransport final : public MissionTransport {
 public:
  LoopTransport(ClosedLoop& loop, const control::Mission& mission, const FlightObserver& observer)
      : loop_(loop),
        mission_(mission),
        observer_(observer),
        status_(loop.controller.status()),
        imu_period_ns_(plant::period_ns(loop.imu_rate_hz)) {
    observe();
  }

  void wait_until_ready() override { step_to(FlightSchedule::kFirstRequestNs); }
  Reply arm() override { return request(control::RequestKind::kArm); }
  void wait(std::int64_t duration_ns, const std::string&) override {
    step_to(loop_.plant.stamp_ns() + duration_ns);
  }
  Reply start_mission() override {
    const Reply uploaded = request(control::RequestKind::kMissionUpload);
    const Reply reply = uploaded.accepted ? request(control::RequestKind::kMissionStart) : uploaded;
    started_ = reply.accepted;
    return reply;
  }
  void advance() override {
    loop_.step();
    if (observer_.stepped) observer_.stepped();
    if (!observe()) throw FlightFailure("it was cancelled");
  }
  [[noreturn]] void abandon(const std::string& reason) override {
    const std::int64_t abandoned_ns = loop_.answered->stamp_ns;
    const bool aborted = status().mission == control::MissionState::kAborted;
    for (std::int64_t until_ns = abandoned_ns + (aborted ? FlightSchedule::kLandAfterNs : 0);;
         until_ns += FlightSchedule::kLandAfterNs) {
      while (!status().rotors_off && loop_.plant.stamp_ns() + imu_period_ns_ <= until_ns) advance();
      if (status().rotors_off) throw FlightFailure(reason + "; " + end_of(status_.mode, started_));
      if (math::seconds(until_ns - abandoned_ns) > FlightSchedule::kLandingTimeoutS)
        throw FlightFailure(reason + "; the vehicle did not land within 30 s");
      if (!comes_down(status_.mode))
        request(started_ ? control::RequestKind::kLand : control::RequestKind::kDisarm);
    }
  }
  Status status() const override {
    const bool flown = status_.mission.id == mission_.id;
    return {loop_.plant.stamp_ns(), flown ? status_.mission.state : control::MissionState::kNone,
            control::rotors_off(status_.mode)};
  }
  std::string abort_reason() const override { return control::to_string(status_.reason); }

 private:
  Reply request(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    if (kind == control::RequestKind::kLand) request.speed = FlightSchedule::kLandingSpeed;
    if (kind == control::RequestKind::kMissionUpload) request.mission = &mission_;
    const control::Outcome outcome = loop_.controller.request(request);
    if (observer_.requested) observer_.requested(request, outcome);
    return {outcome.accepted, !outcome.accepted, outcome.reason};
  }

  void step_to(std::int64_t stamp_ns) {
    while (loop_.plant.stamp_ns() < stamp_ns) advance();
  }

  // Returns false if the flight is cancelled.
  bool observe() {
    if (observer_.trace != nullptr) observer_.trace->add(loop_.plant.truth(), loop_.command);
    if (observer_.record != nullptr) record(*observer_.record);
    return !observer_.cancelled || !plant::is_telemetry_sample(loop_.plant.imu_count(), imu_period_ns_) ||
           !observer_.cancelled();
  }

  // True if control has answered a sample at the telemetry rate since the last call, or the first one after a missed one.
  bool answered_sample() {
    if (!loop_.answered) return false;
    const std::uint64_t before = std::exchange(answered_sequence_, loop_.answered->sequence);
    return before != answered_sequence_ &&
           plant::is_telemetry_sample(answered_sequence_, before, imu_period_ns_);
  }

  void record(record::Flight& flight) {
    const std::int64_t stamp_ns = loop_.plant.stamp_ns();
    flight.truth.push_back(row_of(loop_.plant.truth()));
    const control::MissionProgress& now = status_.mission;
    if (now.id != recorded_.id || now.state != recorded_.state || now.item_index != recorded_.item_index) {
      const bool is_over =
          now.state == control::MissionState::kCompleted || now.state == control::MissionState::kAborted;
      flight.mission.push_back(
          {stamp_ns, now.id, static_cast<int>(now.state), static_cast<std::uint32_t>(now.item_index),
           static_cast<std::uint32_t>(now.item_count), is_over ? control::to_string(status_.reason) : ""});
      recorded_ = now;
    }
    if (!answered_sample()) return;
    const control::Estimate& estimate = loop_.controller.estimate();
    flight.reference.push_back(reference_row(loop_.answered->stamp_ns));
    record::EstimateRow row;
    row.stamp_ns = estimate.stamp_ns;
    row.position_ned = array(estimate.position_ned);
    row.velocity_ned = array(estimate.velocity_ned);
    flight.estimate.push_back(row);
  }

  record::ReferenceRow reference_row(std::int64_t stamp_ns) const {
    const control::Reference& reference = loop_.controller.reference();
    const control::AttitudeSetpoint& setpoint = loop_.controller.attitude_setpoint();
    const Eigen::Quaterniond q(control::attitude_along(setpoint.body_z_ned, setpoint.yaw_rad));
    record::ReferenceRow row;
    row.stamp_ns = stamp_ns;
    row.mode = static_cast<int>(status_.mode);
    row.position_ned = array(reference.position_ned);
    row.velocity_ned = array(reference.velocity_ned);
    row.acceleration_ned = array(reference.acceleration_ned);
    row.yaw_rad = reference.yaw_rad;
    row.q_ned_from_frd = {q.w(), q.x(), q.y(), q.z()};
    row.thrust_n = setpoint.thrust_n;
    row.moment_frd = array(setpoint.moment_frd);
    return row;
  }

  ClosedLoop& loop_;
  const control::Mission& mission_;
  const FlightObserver& observer_;
  const control::Status& status_;
  std::int64_t imu_period_ns_;
  bool started_ = false;
  std::uint64_t answered_sequence_ = 0;
  control::MissionProgress recorded_;
};

}  // namespace

SimulatedFlight fly(ClosedLoop& loop, const control::Mission& mission, double planned_duration_s,
                    const FlightObserver& observer) {
  SimulatedFlight flight;
  try {
    LoopTransport transport(loop, mission, observer);
    fly_mission(transport, planned_duration_s);
    flight.completed = true;
  } catch (const FlightFailure& failure) {
    flight.reason = failure.what();
  }
  flight.simulated_s = loop.time_s();
  return flight;
}

}  // namespace swiftlet::simulation

#include "swiftlet/simulation/simulated_flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/recording/telemetry_rate.hpp"
#include "swiftlet/simulation/flight_schedule.hpp"

namespace swiftlet::ground {
namespace {

std::array<double, 3> array(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

TruthRow row_of(const plant::TruthSample& truth) {
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

class Run {
 public:
  Run(ClosedLoop& loop, const control::Mission& mission, const FlightObserver& observer)
      : loop_(loop),
        mission_(mission),
        observer_(observer),
        status_(loop.controller.status()),
        imu_period_ns_(plant::period_ns(loop.imu_rate_hz)) {
    observe();
  }

  SimulatedFlight fly(double planned_duration_s) {
    SimulatedFlight flight;
    flight.completed = arm() && start() && follow(FlightSchedule::time_limit_s(planned_duration_s));
    flight.reason = reason_;
    flight.simulated_s = loop_.time_s();
    return flight;
  }

 private:
  bool fail(const std::string& reason) {
    reason_ = reason;
    return false;
  }

  bool step() {
    loop_.step();
    return observe() || fail("it was cancelled");
  }

  bool step_to(std::int64_t stamp_ns) {
    while (loop_.plant.stamp_ns() < stamp_ns) {
      if (!step()) return false;
    }
    return true;
  }

  bool arm() {
    if (!step_to(FlightSchedule::kFirstRequestNs)) return false;
    control::Request request;
    request.kind = control::RequestKind::kArm;
    while (true) {
      const control::Outcome outcome = loop_.controller.request(request);
      if (outcome.accepted) return true;
      const std::int64_t next_ns = loop_.plant.stamp_ns() + FlightSchedule::kRetryNs;
      if (next_ns > FlightSchedule::kLastArmingNs) return fail(std::string("arming: ") + outcome.reason);
      if (!step_to(next_ns)) return false;
    }
  }

  bool start() {
    control::Request request;
    request.kind = control::RequestKind::kMissionUpload;
    request.mission = &mission_;
    control::Outcome outcome = loop_.controller.request(request);
    if (outcome.accepted) {
      request.kind = control::RequestKind::kMissionStart;
      outcome = loop_.controller.request(request);
    }
    return outcome.accepted || fail(std::string("the mission was refused: ") + outcome.reason);
  }

  bool follow(double time_limit_s) {
    const double end_s = loop_.time_s() + time_limit_s;
    while (true) {
      if (!step()) return false;
      const bool is_over = status_.mission.id == mission_.id;
      if (is_over && status_.mission.state == control::MissionState::kCompleted && rotors_off(status_.mode))
        return true;
      if (is_over && status_.mission.state == control::MissionState::kAborted)
        return fail(std::string("the mission was aborted: ") + control::to_string(status_.reason));
      if (loop_.time_s() > end_s) {
        const std::string reason = fmt::format("the mission took longer than {:.0f} s", time_limit_s);
        return fail(reason);
      }
    }
  }

  // Returns false if the flight is cancelled.
  bool observe() {
    const bool sampled = runtime::is_telemetry_sample(loop_.plant.imu_count(), imu_period_ns_);
    if (observer_.trace != nullptr) observer_.trace->add(loop_.plant.truth(), loop_.command);
    if (observer_.record != nullptr) record(*observer_.record, sampled);
    return !sampled || !observer_.cancelled || !observer_.cancelled();
  }

  void record(FlightRecord& record, bool sampled) {
    const std::int64_t stamp_ns = loop_.plant.stamp_ns();
    record.truth.append(row_of(loop_.plant.truth()));
    const control::MissionProgress& now = status_.mission;
    if (now.id != last_recorded_.id || now.state != last_recorded_.state ||
        now.item_index != last_recorded_.item_index) {
      record.mission.append(
          {stamp_ns, now.id, static_cast<int>(now.state), static_cast<std::uint32_t>(now.item_index)});
      last_recorded_ = now;
    }
    if (!sampled || !loop_.plant.imu()) return;
    const control::Reference& reference = loop_.controller.reference();
    const control::Estimate& estimate = loop_.controller.estimate();
    record.reference.append({stamp_ns, static_cast<int>(status_.mode), array(reference.position_ned),
                             array(reference.velocity_ned), reference.yaw_rad});
    record.estimate.append({estimate.stamp_ns, array(estimate.position_ned), array(estimate.velocity_ned)});
  }

  ClosedLoop& loop_;
  const control::Mission& mission_;
  const FlightObserver& observer_;
  const control::Status& status_;
  std::int64_t imu_period_ns_;
  control::MissionProgress last_recorded_;
  std::string reason_;
};

}  // namespace

SimulatedFlight fly(ClosedLoop& loop, const control::Mission& mission, double planned_duration_s,
                    const FlightObserver& observer) {
  return Run(loop, mission, observer).fly(planned_duration_s);
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/cli/status_json.hpp"

#include <cmath>

#include "swiftlet/control/supervision/events.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/ground/client/silence.hpp"
#include "swiftlet/ground/terminal/state_lines.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const msg::ControlGains& gains) {
  return {{"attitude_angle_per_s2", gains.attitude_angle()},
          {"attitude_rate_per_s", gains.attitude_rate()},
          {"attitude_acceleration", gains.attitude_acceleration()},
          {"position_p_per_s2", gains.position_p()},
          {"position_v_per_s", gains.position_v()},
          {"position_i_per_s3", gains.position_i()},
          {"integral_limit_m_s2", gains.integral_limit()},
          {"disturbance_bandwidth_rad_s", gains.disturbance_bandwidth()},
          {"disturbance_limit_m_s2", gains.disturbance_limit()}};
}

Json measured_or_null(double value) { return std::isfinite(value) && value >= 0.0 ? Json(value) : Json(); }

template <class T>
Json age_of(const Latest<T>& latest, Clock::time_point now) {
  if (!latest.seen()) return nullptr;
  return latest.age_s(now);
}

// What a controller does not report is null.
Json controllers_json(const LiveControllers& controllers) {
  Json list = Json::array();
  const Json unknown = {{"number", nullptr},
                        {"role", nullptr},
                        {"ready", nullptr},
                        {"failover_priority", nullptr},
                        {"term", nullptr}};
  for (const LiveController& controller : controllers.known) {
    Json entry = unknown;
    entry["number"] = controller.number;
    entry["role"] = role_name(controller);
    if (controller.state) {
      entry["ready"] = controller.state->ready();
      entry["failover_priority"] = controller.state->failover_priority();
      entry["term"] = controller.state->term();
    }
    list.push_back(entry);
  }
  list.insert(list.end(), static_cast<std::size_t>(controllers.others), unknown);
  return list;
}

Json odometry_json(const msg::ControlStatus& control) {
  if (odometry_text(control).empty()) return nullptr;
  return {{"in_force", control.estimate_source() == msg::ControlStatus_Constants::ESTIMATE_OF_VEHICLE},
          {"distance_m", control.odometry_distance_m()},
          {"angle_rad", control.odometry_angle_rad()},
          {"resets", control.odometry_resets()}};
}

void add_estimate(const Latest<msg::Estimate>& latest, Json& json) {
  json["position_ned_m"] = nullptr;
  json["velocity_ned_m_s"] = nullptr;
  json["attitude_rad"] = nullptr;
  if (!latest.seen()) return;
  const msg::Estimate& estimate = latest.message;
  json["position_ned_m"] = estimate.position_ned();
  json["velocity_ned_m_s"] = estimate.velocity_ned();
  const math::EulerAngles attitude =
      math::euler_angles(messages::wire::quaternion(estimate.q_ned_from_frd()));
  json["attitude_rad"] = {
      {"roll", attitude.roll_rad}, {"pitch", attitude.pitch_rad}, {"yaw", attitude.heading.yaw_rad}};
  json["poses"] = {{"fault", pose_fault_name(estimate.pose_fault())},
                   {"accepted", estimate.poses_accepted()},
                   {"refused", estimate.poses_refused()},
                   {"resets", estimate.resets()}};
}

Json battery_json(const Latest<msg::Battery>& latest) {
  if (!latest.seen()) return nullptr;
  const msg::Battery& battery = latest.message;
  return {{"voltage_v", battery.voltage_v()},
          {"current_a", battery.current_a()},
          {"charge", battery.state_of_charge()}};
}

Json mission_json(const msg::MissionStatus& mission) {
  return {{"id", mission.mission_id()},
          {"state", mission_state_name(mission.state())},
          {"item", mission.state() == msg::MissionStatus_Constants::NONE ? 0 : mission.item_index() + 1},
          {"items", mission.item_count()},
          {"reason", mission.reason().c_str()}};
}

Json request_json(const msg::RequestStatus& request) {
  if (request.state() == msg::RequestStatus_Constants::UNKNOWN) return nullptr;
  return {{"kind", kind_name(request)},
          {"state", state_name(request)},
          {"progress", request.progress()},
          {"result", request.result().c_str()}};
}

Json loop_json(const msg::ControlStatus& control) {
  return {{"level", levels_text(control.control_level())},
          {"rate_hz", control.rate_hz()},
          {"cycles", control.cycles()},
          {"deadline_misses", control.deadline_misses()},
          {"step_time_max_us", control.step_time_max_us()},
          {"realtime_scheduling", control.realtime_scheduling()}};
}

Json delay_json(const msg::ControlStatus& control) {
  return {{"p50", measured_or_null(control.loop_delay_p50_s())},
          {"p95", measured_or_null(control.loop_delay_p95_s())},
          {"margin", measured_or_null(control.delay_margin_s())},
          {"near_margin", control.delay_near_margin()}};
}

Json clock_json(const Latest<msg::ClockStatus>& latest) {
  if (!latest.seen()) return nullptr;
  const msg::ClockStatus& clock = latest.message;
  return {{"known", clock.known()},
          {"offset_s", 1e-9 * static_cast<double>(clock.offset_ns())},
          {"uncertainty_s", 1e-9 * clock.uncertainty_ns()},
          {"drift", clock.drift()},
          {"drift_uncertainty", clock.drift_uncertainty()},
          {"round_trip_s", 1e-9 * clock.round_trip_ns()},
          {"steps", clock.steps()}};
}

Json vehicle_json(const Latest<msg::VehicleInfo>& latest) {
  if (!latest.seen()) return nullptr;
  const msg::VehicleInfo& info = latest.message;
  return {{"name", info.name().c_str()},
          {"simulated", info.simulated()},
          {"autopilot", info.autopilot().c_str()},
          {"imu_rate_hz", info.imu_rate_hz()},
          {"control_levels", levels_text(info.control_levels())},
          {"rotors_running", info.rotors_running()},
          {"fault", info.fault().c_str()},
          {"sense_to_actuate_us",
           {{"p50", info.sense_to_actuate_p50_us()},
            {"p99", info.sense_to_actuate_p99_us()},
            {"max", info.sense_to_actuate_max_us()}}}};
}

Json peers_json(const View& view) {
  Json peers = Json::object();
  for (const auto& [name, count] : view.peers) peers[name] = count > 0;
  return peers;
}

}  // namespace

std::string levels_text(std::uint8_t bits) { return plant::ControlLevels::from_bits(bits).names().data(); }

const char* role_name(const LiveController& controller) { return controller.active ? "active" : "standby"; }

const char* kind_name(const msg::RequestStatus& request) {
  control::Event event{};
  return control::event_of(static_cast<control::RequestKind>(request.kind()), event)
             ? control::to_string(event)
             : "unknown";
}

const char* state_name(const msg::RequestStatus& request) {
  return control::to_string(static_cast<control::RequestState>(request.state()));
}

Json status_json(const View& view, const TopicRates& rates, const CommandOptions& options,
                 const std::vector<std::string>& mismatches) {
  const auto now = Clock::now();
  const auto& control = view.control.message;
  Json json;
  json["vehicle"] = options.network.vehicle;
  json["domain"] = options.network.domain;
  json["silent"] = to_json(silences_of(view, now));
  json["source_conflict"] = control.source_conflict().c_str();
  json["mismatches"] = mismatches;
  json["mode"] = mode_name(control.mode());
  json["reason"] = control.reason().c_str();
  json["airborne"] = control.airborne();
  json["has_pose"] = control.has_pose();
  json["pose_age_s"] = pose_age_s(view, now);
  json["odometry"] = odometry_json(control);
  add_estimate(view.estimate, json);
  json["battery"] = battery_json(view.battery);
  json["mission"] = mission_json(view.mission.message);
  json["request"] = request_json(control.request());
  json["control"] = loop_json(control);
  json["loop_delay_s"] = delay_json(control);
  json["clock"] = clock_json(view.clock);
  json["settings"] = {{"name", control.settings().c_str()},
                      {"progress", control.gains_progress()},
                      {"gains", to_json(control.gains())}};
  json["controllers"] = controllers_json(controllers_of(view, now));
  json["vehicle_info"] = vehicle_json(view.vehicle);
  json["rates_hz"] = {{"estimate", rates.estimate_hz},
                      {"reference", rates.reference_hz},
                      {"battery", rates.battery_hz},
                      {"ground_truth", rates.ground_truth_hz}};
  json["ages_s"] = {
      {"control_status", age_of(view.control, now)}, {"vehicle_info", age_of(view.vehicle, now)},
      {"estimate", age_of(view.estimate, now)},      {"reference", age_of(view.reference, now)},
      {"battery", age_of(view.battery, now)},        {"ground_truth", age_of(view.truth, now)}};
  json["peers_alive"] = peers_json(view);
  if (!view.control.seen()) {  // an autopilot flies in place of control
    for (const char* of_control : {"source_conflict", "mode", "reason", "airborne", "has_pose", "mission",
                                   "request", "control", "loop_delay_s", "settings"})
      json[of_control] = nullptr;
  }
  return json;
}

}  // namespace swiftlet::ground

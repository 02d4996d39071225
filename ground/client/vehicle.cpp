#include "swiftlet/ground/client/vehicle.hpp"

#include <algorithm>
#include <utility>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/connection_watch.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;
using control::RequestKind;
using messages::wire::quaternion;
using messages::wire::vector;
using std::chrono::milliseconds;

constexpr double kMaxExtrapolation_s = 0.02;
constexpr milliseconds kConnectionPollPeriod{50};

dds::NodeSettings of_vehicle(dds::NodeSettings network, const std::string& name) {
  network.vehicle = name;
  return network;
}

control::Request of_kind(RequestKind kind, std::uint64_t mission_id = 0) {
  control::Request request;
  request.kind = kind;
  request.mission_id = mission_id;
  return request;
}

VehicleState state_of(const View& view) {
  VehicleState state;
  if (view.control.seen()) {
    state.mode = static_cast<Mode>(view.control.message.mode());
    state.mode_reason = view.control.message.reason().c_str();
    state.airborne = view.control.message.airborne();
    state.has_pose = view.control.message.has_pose();
    state.age_s = view.control.age_s(Clock::now());
    state.setpoints = {view.control.message.setpoints_accepted(), view.control.message.setpoints_refused(),
                       view.control.message.setpoint_refusal().c_str()};
  }
  if (view.estimate.seen()) {
    const msg::Estimate& estimate = view.estimate.message;
    state.stamp_ns = estimate.stamp_ns();
    state.position_ned_m = vector(estimate.position_ned());
    state.velocity_ned_m_s = vector(estimate.velocity_ned());
    state.q_ned_from_frd = quaternion(estimate.q_ned_from_frd());
    state.body_rates_frd_rad_s = vector(estimate.body_rates_frd());
  }
  if (view.reference.seen()) state.reference_position_ned_m = vector(view.reference.message.position_ned());
  if (view.mission.seen()) {
    const msg::MissionStatus& mission = view.mission.message;
    state.mission.id = mission.mission_id();
    state.mission.state = static_cast<control::MissionState>(mission.state());
    state.mission.items = static_cast<int>(mission.item_count());
    state.mission.item = state.mission.items > 0 ? static_cast<int>(mission.item_index()) + 1 : 0;
    state.mission.reason = mission.reason().c_str();
  }
  if (view.battery.seen()) {
    state.battery_voltage_v = view.battery.message.voltage_v();
    state.battery_charge = view.battery.message.state_of_charge();
  }
  return state;
}

}  // namespace

SetpointTally SetpointTally::since(const SetpointTally& before) const {
  const auto grown = [](std::uint64_t from, std::uint64_t to) { return to - (to < from ? 0 : from); };
  return {grown(before.accepted, accepted), grown(before.refused, refused), refusal};
}

Vehicle::Vehicle(const dds::NodeSettings& network) : client_(std::make_shared<Client>(network)) {}

Vehicle::Vehicle(const Context& context, const std::string& name, Telemetry telemetry)
    : client_(
          std::make_shared<Client>(context.participant(), of_vehicle(context.network(), name), telemetry)) {}

Vehicle::Vehicle(std::shared_ptr<Client> client) : client_(std::move(client)) {}

Vehicle::~Vehicle() = default;

const std::string& Vehicle::name() const { return client_->vehicle(); }

bool Vehicle::connected() const { return is_connected(client_->view(), Clock::now()); }

void Vehicle::on_connection(std::function<void(const ConnectionEvent&)> callback) {
  periodic_task_.reset();
  if (!callback) return;
  const auto update = [client = client_, watch = std::make_shared<ConnectionWatch>(),
                       report = std::move(callback)] {
    if (const auto event = watch->update(client->view(), Clock::now())) report(*event);
  };
  periodic_task_ = std::make_unique<dds::PeriodicTask>(kConnectionPollPeriod, update);
}

Result Vehicle::connect(milliseconds timeout) const {
  const auto is_cancelled = [this] { return cancelled_ && cancelled_(); };
  const auto deadline = Clock::now() + timeout;
  client_->wait(timeout, [&](const View& view) {
    return view.control.seen() || !view.foreign_control.empty() || is_cancelled();
  });
  const bool found = client_->view().control.seen();
  if (found) client_->await_setpoint_reader(deadline, is_cancelled);
  if (is_cancelled()) return {Result::Kind::kCancelled, "the request was cancelled"};
  if (found) return {Result::Kind::kAccepted, ""};
  return {Result::Kind::kNoControl, client_->no_control()};
}

void Vehicle::cancel_when(std::function<bool()> cancelled) { cancelled_ = std::move(cancelled); }

VehicleState Vehicle::state() const { return state_of(client_->view()); }

bool Vehicle::wait_until(const std::function<bool(const VehicleState&)>& holds, milliseconds timeout) const {
  return client_->wait(timeout, [&holds](const View& view) { return holds(state_of(view)); });
}

ActionHandle Vehicle::request(const control::Request& request, milliseconds timeout) {
  return {client_, client_->request(request, timeout, cancelled_)};
}

ActionHandle Vehicle::arm(milliseconds timeout) { return request(of_kind(RequestKind::kArm), timeout); }

ActionHandle Vehicle::disarm(milliseconds timeout) { return request(of_kind(RequestKind::kDisarm), timeout); }

ActionHandle Vehicle::take_off(double height_m, double speed_m_s, milliseconds timeout) {
  control::Request takeoff = of_kind(RequestKind::kTakeoff);
  takeoff.position_ned.z() = -height_m;
  takeoff.speed = speed_m_s;
  return request(takeoff, timeout);
}

ActionHandle Vehicle::go_to(const Target& place, milliseconds timeout) {
  control::Request go_to = of_kind(RequestKind::kGoTo);
  go_to.position_ned = place.position_ned_m;
  go_to.yaw_free = !place.yaw_rad;
  go_to.yaw_rad = place.yaw_rad.value_or(0.0);
  go_to.speed = place.speed_m_s;
  return request(go_to, timeout);
}

ActionHandle Vehicle::hold(milliseconds timeout) { return request(of_kind(RequestKind::kHold), timeout); }

ActionHandle Vehicle::land(double speed_m_s, milliseconds timeout) {
  control::Request land = of_kind(RequestKind::kLand);
  land.speed = speed_m_s;
  return request(land, timeout);
}

ActionHandle Vehicle::stop(milliseconds timeout) { return request(of_kind(RequestKind::kStop), timeout); }

ActionHandle Vehicle::upload(const control::Mission& mission, milliseconds timeout) {
  return {client_, client_->upload(mission, timeout, cancelled_)};
}

std::uint64_t Vehicle::uploaded_id() const { return client_->mission_id(); }

ActionHandle Vehicle::follow(const control::Mission& mission, milliseconds timeout) {
  Result uploaded = client_->upload(mission, timeout, cancelled_);
  if (!uploaded.accepted()) return {client_, std::move(uploaded)};
  return start_mission(client_->mission_id(), timeout);
}

ActionHandle Vehicle::start_mission(std::uint64_t id, milliseconds timeout) {
  return request(of_kind(RequestKind::kMissionStart, id), timeout);
}

ActionHandle Vehicle::pause_mission(std::uint64_t id, milliseconds timeout) {
  return request(of_kind(RequestKind::kMissionPause, id), timeout);
}

ActionHandle Vehicle::resume_mission(std::uint64_t id, milliseconds timeout) {
  return request(of_kind(RequestKind::kMissionResume, id), timeout);
}

ActionHandle Vehicle::skip_mission_item(std::uint64_t id, milliseconds timeout) {
  return request(of_kind(RequestKind::kMissionSkip, id), timeout);
}

ActionHandle Vehicle::clear_mission(std::uint64_t id, milliseconds timeout) {
  return request(of_kind(RequestKind::kMissionClear, id), timeout);
}

ActionHandle Vehicle::follow(const control::Trajectory& trajectory, milliseconds timeout) {
  return {client_, client_->upload(trajectory, timeout, cancelled_)};
}

ActionHandle Vehicle::change_settings(const control::SettingsRequest& settings, milliseconds timeout) {
  return {client_, client_->change_settings(settings, timeout, cancelled_)};
}

void Vehicle::enable_link_loss_failsafe() { client_->enable_link_loss_failsafe(); }

void Vehicle::disable_link_loss_failsafe() { client_->disable_link_loss_failsafe(); }

double Vehicle::clock_s() const {
  const View view = client_->view();
  if (!view.estimate.seen()) return VehicleState::kUnknown;
  return 1e-9 * static_cast<double>(view.estimate.message.stamp_ns()) +
         std::min(view.estimate.age_s(Clock::now()), kMaxExtrapolation_s);
}

bool Vehicle::send(const control::Setpoint& setpoint) { return client_->send(setpoint); }

}  // namespace swiftlet::ground

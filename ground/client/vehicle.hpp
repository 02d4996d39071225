// The C++ API to one vehicle: connect, arm, take off, go to positions, follow missions and trajectories,
// stream setpoints, hold, land. The command `swiftlet` is built on it; ground/examples shows its use.
//
//   swiftlet::ground::Vehicle vehicle;  // kl1 in domain 0
//   if (!vehicle.connect().accepted() || !vehicle.arm().wait().done()) return 1;
//   vehicle.take_off(1.0).wait();
//   vehicle.go_to({{1, 0, -1}}).wait();  // m, NED
//   vehicle.land().wait();
//
// Each request blocks until the controller answers it and returns an ActionHandle, whose wait() blocks until
// the action ends. Positions are in metres north, east and down of the origin (NED): 1 m up is z = -1.
// Several vehicles share one Context (ground/client/context.hpp). A Vehicle stays usable if its control
// process is restarted or a standby takes over.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings_request.hpp"
#include "swiftlet/ground/client/action.hpp"
#include "swiftlet/ground/client/connection.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/result.hpp"
#include "swiftlet/ground/client/telemetry.hpp"
#include "swiftlet/ground/client/vehicle_setpoints.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::dds {
class PeriodicTask;
}

namespace swiftlet::ground {

class Client;

// Setpoints that the controller received since it became active.
struct SetpointTally {
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::string refusal;  // a sentence: why the last one was refused

  // Counted since `before`. A controller that took over in between counts from 0.
  SetpointTally since(const SetpointTally& before) const;
};

// The state of the mission that the vehicle has.
struct MissionProgress {
  std::uint64_t id = 0;
  control::MissionState state = control::MissionState::kNone;
  int item = 0;  // the item being flown, from 1; 0 without a mission
  int items = 0;
  std::string reason;  // why it was aborted
};

// The newest state that the vehicle and its controller reported. NaN: not received yet.
struct VehicleState {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  control::Mode mode = control::Mode::kDisarmed;
  std::string mode_reason;  // why the mode was entered
  bool airborne = false;
  bool has_pose = false;      // motion capture poses arrive
  double age_s = kUnknown;    // since the last control_status
  std::int64_t stamp_ns = 0;  // of the estimate, on the vehicle's clock
  Eigen::Vector3d position_ned_m = Eigen::Vector3d::Constant(kUnknown);  // estimated
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Quaterniond q_ned_from_frd{kUnknown, kUnknown, kUnknown, kUnknown};
  Eigen::Vector3d body_rates_frd_rad_s = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d reference_position_ned_m = Eigen::Vector3d::Constant(kUnknown);
  double battery_voltage_v = kUnknown;
  double battery_charge = kUnknown;  // 0 empty .. 1 full
  MissionProgress mission;
  SetpointTally setpoints;
};

// Thread-safe. Requests of several threads do not wait for each other.
class Vehicle {
 public:
  static constexpr std::chrono::milliseconds kAnswerTimeout{5000};

  // network.vehicle and network.domain select the vehicle; network.name is this program's name in the domain.
  // Throws std::runtime_error if the network cannot be joined.
  explicit Vehicle(const dds::NodeSettings& network = {"ground"});
  // Shares the context's participant; the Context may be destroyed first. Without telemetry, state() knows only the
  // mode, the mission and the model, and clock_s() is NaN. Throws std::runtime_error if `name` is not a valid vehicle
  // name.
  Vehicle(const Context& context, const std::string& name, Telemetry telemetry = Telemetry::kReceived);
  // Shares a client, for programs that also work on its messages.
  explicit Vehicle(std::shared_ptr<Client> client);
  ~Vehicle();
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  // Waits for the vehicle's control_status, and until its controller reads setpoints. Accepted when both are
  // there, or the first at the end of the time; else the reason says what was found in the domain. Not required
  // before requests: they wait for the controller themselves, within their time-out.
  Result connect(std::chrono::milliseconds timeout = kAnswerTimeout) const;

  // The vehicle's name in the domain.
  const std::string& name() const;

  // True if a control_status arrived within the last second.
  bool connected() const;
  // Calls `callback` when the control process connects, is lost or is replaced, and at once if it is
  // connected already. The callback runs in a thread of its own and may call any method but this one. A later
  // call replaces the callback. An ActionHandle reports whether a request survives such an event.
  void on_connection(std::function<void(const ConnectionEvent&)> callback);

  // From now on, connect() and the requests of this object stop waiting for an answer as soon as `cancelled`
  // returns true: they return Result::Kind::kCancelled. An empty function removes it. Do not call it while a
  // request waits.
  void cancel_when(std::function<bool()> cancelled);

  VehicleState state() const;
  // Waits until `holds` returns true for the state. Returns false after the time-out.
  bool wait_until(const std::function<bool(const VehicleState&)>& holds,
                  std::chrono::milliseconds timeout) const;

  // Requests. `timeout` limits the wait for the answer.
  // Any request without a mission, trajectory or gains of its own; those below are the usual ones.
  ActionHandle request(const control::Request& request, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle arm(std::chrono::milliseconds timeout = kAnswerTimeout);     // done: rotors turn
  ActionHandle disarm(std::chrono::milliseconds timeout = kAnswerTimeout);  // on the ground only
  // Climbs straight up to height_m above the origin and holds. speed_m_s: peak.
  ActionHandle take_off(double height_m, double speed_m_s = 0.5,
                        std::chrono::milliseconds timeout = kAnswerTimeout);
  struct Target {
    Eigen::Vector3d position_ned_m;
    std::optional<double> yaw_rad{};  // from north towards east; kept if not given
    double speed_m_s = 0.5;           // peak
  };
  // Flies straight to the target and holds.
  ActionHandle go_to(const Target& place, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle hold(std::chrono::milliseconds timeout = kAnswerTimeout);  // done: at rest
  ActionHandle land(double speed_m_s = 0.4, std::chrono::milliseconds timeout = kAnswerTimeout);
  // Switches the rotors off at once, in flight too.
  ActionHandle stop(std::chrono::milliseconds timeout = kAnswerTimeout);
  // Uploads a mission without starting it. Its id is then uploaded_id().
  ActionHandle upload(const control::Mission& mission, std::chrono::milliseconds timeout = kAnswerTimeout);
  std::uint64_t uploaded_id() const;
  // Uploads the mission and starts it.
  ActionHandle follow(const control::Mission& mission, std::chrono::milliseconds timeout = kAnswerTimeout);
  // Commands to the mission that the vehicle has. id: refused if the vehicle's mission has another id; 0
  // means any. Start, resume and skip are done when the mission is completed, pause when the vehicle is at
  // rest.
  ActionHandle start_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle pause_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle resume_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle skip_mission_item(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle clear_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  // Accepted while holding, streaming setpoints or following another trajectory. The vehicle joins the
  // trajectory without a step in position, velocity, acceleration or jerk.
  ActionHandle follow(const control::Trajectory& trajectory,
                      std::chrono::milliseconds timeout = kAnswerTimeout);

  // Flies with other control settings, after a change of the gains over settings.ramp_s. Done: the gains are
  // in force. Refused if a loop would be unstable on the way, if a fixed setting differs, and outside calm
  // flight.
  ActionHandle change_settings(const control::SettingsRequest& settings,
                               std::chrono::milliseconds timeout = kAnswerTimeout);

  // Enables the link-loss failsafe: if this program falls silent, the controller does what its setting
  // failsafe.ground_link_action says. Ends with disable_link_loss_failsafe() or with this object. Call both
  // from one thread.
  void enable_link_loss_failsafe();
  void disable_link_loss_failsafe();

  // The vehicle's clock, s; NaN before its first estimate. Time setpoint streams by it: a simulation may be
  // slower than real time. Stops 20 ms after the last estimate.
  double clock_s() const;

  // Publishes one setpoint of a stream of at least 2 Hz. The vehicle follows the stream from hold on and
  // holds when it stops. idl/README.md describes each kind and what is refused. Fills in stamp and sequence.
  // Returns false if no controller subscribes.
  bool send(const PositionSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const VelocitySetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const AccelerationSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const AttitudeSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const BodyRatesSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const control::Setpoint& setpoint);

 private:
  std::shared_ptr<Client> client_;
  std::function<bool()> cancelled_;
  std::unique_ptr<dds::PeriodicTask> periodic_task_;  // last: it uses client_
};

}  // namespace swiftlet::ground

// One vehicle, as a program that flies it sees it: connect, arm, take off, go to places, follow missions and
// trajectories, stream setpoints, hold, land. The command `swiftlet` stands on it; ground/examples shows it
// in use.
//
//   swiftlet::ground::Vehicle vehicle;  // kl1 in domain 0
//   if (!vehicle.connect().accepted() || !vehicle.arm().wait().done()) return 1;
//   vehicle.take_off(1.0).wait();
//   vehicle.go_to({{1, 0, -1}}).wait();  // m, NED
//   vehicle.land().wait();
//
// Each request waits for its answer and gives a ActionHandle, whose wait() returns when it is done. Positions
// are metres north, east and down of the origin (NED): 1 m up is z = -1. Several vehicles share one Context
// (ground/context.hpp). A control process that is started again, or one that takes over, is gone on with.
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
#include "swiftlet/ground/client/action.hpp"
#include "swiftlet/ground/client/connection.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/result.hpp"
#include "swiftlet/ground/client/vehicle_setpoints.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {
class PeriodicTask;
}

namespace swiftlet::ground {

class Client;

// What became of the setpoints that reached the controller, since it began to fly this vehicle.
struct SetpointTally {
  std::uint64_t taken = 0;
  std::uint64_t refused = 0;
  std::string refusal;  // of the last that was refused: a sentence
};

// Of the mission that the vehicle has.
struct MissionProgress {
  std::uint64_t id = 0;
  control::MissionState state = control::MissionState::kNone;
  int item = 0;  // that is flown, from 1; 0 without a mission
  int items = 0;
  std::string reason;  // why it was aborted
};

// The newest of all that the vehicle and its controller have said. NaN where nothing came yet.
struct VehicleState {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  control::Mode mode = control::Mode::kDisarmed;
  std::string mode_reason;  // why it was entered
  bool airborne = false;
  bool has_pose = false;      // motion capture sees it
  double age_s = kUnknown;    // since the controller was heard last
  std::int64_t stamp_ns = 0;  // of the estimate, on the vehicle's clock
  Eigen::Vector3d position_ned_m = Eigen::Vector3d::Constant(kUnknown);  // estimated
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Quaterniond q_ned_from_frd{kUnknown, kUnknown, kUnknown, kUnknown};
  Eigen::Vector3d body_rates_frd_rad_s = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d reference_position_ned_m = Eigen::Vector3d::Constant(kUnknown);  // where it is to be
  double battery_voltage_v = kUnknown;
  double battery_charge = kUnknown;  // 0 empty .. 1 full
  MissionProgress mission;
  SetpointTally setpoints;
};

// Any thread may call it; requests of several threads do not wait for each other.
class Vehicle {
 public:
  static constexpr std::chrono::milliseconds kAnswerTimeout{5000};

  // The vehicle's name and domain are those of `network`; its `name` is this program's own, as others see it.
  // Throws std::runtime_error with a sentence if the network cannot be joined.
  explicit Vehicle(const comms::NodeSettings& network = {"ground"});
  // One of those that share the context, which may end before it. Throws std::runtime_error for a name that
  // cannot be one.
  Vehicle(const Context& context, const std::string& name);
  ~Vehicle();
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  // Accepted once a controller of the vehicle is heard and answers requests; else the reason says what was
  // seen in the domain. Requests do without it: they look for the controller themselves, within their
  // time-out.
  Result connect(std::chrono::milliseconds timeout = kAnswerTimeout) const;

  // The name on the network.
  const std::string& name() const;

  // The control process was heard within the last second.
  bool connected() const;
  // Tells from now on, and at once of one that is heard, when the control process is heard, falls silent, or is
  // another one; which request it knows of is for its ActionHandle to say. The callback runs in a thread of its own
  // and may call all but this. A later call takes the place of an earlier one.
  void on_connection(std::function<void(const ConnectionEvent&)> callback);

  VehicleState state() const;
  // Until `holds` is true of the state; false if it is not within the time-out.
  bool wait_until(const std::function<bool(const VehicleState&)>& holds,
                  std::chrono::milliseconds timeout) const;

  // Requests. `timeout` is that of the answer.
  ActionHandle arm(std::chrono::milliseconds timeout = kAnswerTimeout);     // done: the rotors turn
  ActionHandle disarm(std::chrono::milliseconds timeout = kAnswerTimeout);  // on the ground
  // Straight up to height_m above the origin, and hold there. speed_m_s: peak.
  ActionHandle take_off(double height_m, double speed_m_s = 0.5,
                        std::chrono::milliseconds timeout = kAnswerTimeout);
  struct Target {
    Eigen::Vector3d position_ned_m;
    std::optional<double> yaw_rad{};  // from north to the east; kept if not given
    double speed_m_s = 0.5;           // peak
  };
  // Straight there, and hold.
  ActionHandle go_to(const Target& place, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle hold(std::chrono::milliseconds timeout = kAnswerTimeout);  // done: it has come to rest
  ActionHandle land(double speed_m_s = 0.4, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle stop(
      std::chrono::milliseconds timeout = kAnswerTimeout);  // rotors off at once, wherever it is
  // The vehicle keeps it, to be started: as mission uploaded_id().
  ActionHandle upload(const control::Mission& mission, std::chrono::milliseconds timeout = kAnswerTimeout);
  std::uint64_t uploaded_id() const;
  // Uploads the mission and starts it.
  ActionHandle follow(const control::Mission& mission, std::chrono::milliseconds timeout = kAnswerTimeout);
  // Of the mission that the vehicle has; refused if that is not of this id, 0: whichever it is. Starting,
  // resuming and skipping are done when it has been flown, pausing when the vehicle rests.
  ActionHandle start_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle pause_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle resume_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle skip_mission_item(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  ActionHandle clear_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  // From hold, a setpoint stream or another trajectory; it is joined smoothly from the present motion.
  ActionHandle follow(const control::Trajectory& trajectory,
                      std::chrono::milliseconds timeout = kAnswerTimeout);

  // From now on the flight depends on this program: if it falls silent, the controller does what its
  // settings say (failsafe.ground_link_action). Until leave() or the end of this object. By one thread.
  void enable_link_loss_failsafe();
  void disable_link_loss_failsafe();

  // The vehicle's own clock, s, which a stream goes by: a simulation may be slower than real time. It stands
  // still 20 ms after the vehicle fell silent; NaN before it is heard.
  double clock_s() const;

  // One of a stream of setpoints, at 2 Hz or more, followed from hold on (idl/README.md says what each kind
  // does and what is refused). When the stream stops the vehicle holds. Stamp and sequence are filled in.
  // False if no controller is there.
  bool send(const PositionSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const VelocitySetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const AccelerationSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const AttitudeSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const BodyRatesSetpoint& setpoint) { return send(to_setpoint(setpoint)); }
  bool send(const control::Setpoint& setpoint);

 private:
  ActionHandle request(const control::Request& request, std::chrono::milliseconds timeout);
  ActionHandle request_of_mission(std::uint8_t kind, std::uint64_t id, std::chrono::milliseconds timeout);

  std::shared_ptr<Client> client_;
  std::unique_ptr<comms::PeriodicTask> periodic_task_;  // last: it looks at the client
};

}  // namespace swiftlet::ground

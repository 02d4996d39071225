// One vehicle, as a program that flies it sees it: connect, arm, take off, go to places, follow missions and
// trajectories, stream setpoints, hold, land. The command `swiftlet` stands on it; ground/examples shows it
// in use.
//
//   swiftlet::ground::Vehicle vehicle;  // kl1 in domain 0
//   if (!vehicle.connect().accepted() || !vehicle.arm().wait().done()) return 1;
//   vehicle.take_off(1.0).wait();
//   vehicle.go_to({{1, 0, -1}}).wait();
//   vehicle.land().wait();
//
// Each request waits for its answer and gives a Manoeuvre, whose wait() returns when it is done. Positions
// are metres north, east and down of the origin (NED): 1 m up is z = -1.
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
#include "swiftlet/ground/client/answer.hpp"
#include "swiftlet/ground/client/manoeuvre.hpp"
#include "swiftlet/services/dds/node.hpp"

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
  Eigen::Vector3d position_ned = Eigen::Vector3d::Constant(kUnknown);  // m, estimated
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Constant(kUnknown);  // m/s
  Eigen::Quaterniond q_ned_from_frd{kUnknown, kUnknown, kUnknown, kUnknown};
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Constant(kUnknown);  // rad/s
  Eigen::Vector3d reference_ned = Eigen::Vector3d::Constant(kUnknown);   // m, where it is to be
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
  ~Vehicle();
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  // Accepted once a controller of the vehicle is heard and answers requests; else the reason says what was
  // seen in the domain. Requests do without it: they look for the controller themselves, within their
  // time-out.
  Answer connect(std::chrono::milliseconds timeout = kAnswerTimeout) const;

  VehicleState state() const;
  // Until `holds` is true of the state; false if it is not within the time-out.
  bool wait_until(const std::function<bool(const VehicleState&)>& holds,
                  std::chrono::milliseconds timeout) const;

  // Requests. `timeout` is that of the answer.
  Manoeuvre arm(std::chrono::milliseconds timeout = kAnswerTimeout);     // done: the rotors turn
  Manoeuvre disarm(std::chrono::milliseconds timeout = kAnswerTimeout);  // on the ground
  // Straight up to height_m above the origin, and hold there. speed: m/s, peak.
  Manoeuvre take_off(double height_m, double speed = 0.5, std::chrono::milliseconds timeout = kAnswerTimeout);
  struct Place {
    Eigen::Vector3d position_ned;
    std::optional<double> yaw_rad;  // from north to the east; kept if not given
    double speed = 0.5;             // m/s, peak
  };
  // Straight there, and hold.
  Manoeuvre go_to(const Place& place, std::chrono::milliseconds timeout = kAnswerTimeout);
  Manoeuvre hold(std::chrono::milliseconds timeout = kAnswerTimeout);  // done: it has come to rest
  Manoeuvre land(double speed = 0.4, std::chrono::milliseconds timeout = kAnswerTimeout);
  Manoeuvre stop(std::chrono::milliseconds timeout = kAnswerTimeout);  // rotors off at once, wherever it is
  // The vehicle keeps it, to be started: as mission uploaded_id().
  Manoeuvre upload(const control::Mission& mission, std::chrono::milliseconds timeout = kAnswerTimeout);
  std::uint64_t uploaded_id() const;
  // Uploads the mission and starts it.
  Manoeuvre follow(const control::Mission& mission, std::chrono::milliseconds timeout = kAnswerTimeout);
  // Of the mission that the vehicle has; refused if that is not of this id, 0: whichever it is. Starting,
  // resuming and skipping are done when it has been flown, pausing when the vehicle rests.
  Manoeuvre start_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  Manoeuvre pause_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  Manoeuvre resume_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  Manoeuvre skip_mission_item(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  Manoeuvre clear_mission(std::uint64_t id = 0, std::chrono::milliseconds timeout = kAnswerTimeout);
  // From hold, a setpoint stream or another trajectory; it is joined smoothly from the present motion.
  Manoeuvre follow(const control::Trajectory& trajectory, std::chrono::milliseconds timeout = kAnswerTimeout);

  // From now on the flight depends on this program: if it falls silent, the controller does what its
  // settings say (failsafe.ground_link_action). Until leave() or the end of this object. By one thread.
  void stay();
  void leave();

  // The vehicle's own clock, s, which a stream goes by: a simulation may be slower than real time. It stands
  // still 20 ms after the vehicle fell silent; NaN before it is heard.
  double clock_s() const;

  // One of a stream of setpoints, at 2 Hz or more, followed from hold on (idl/README.md says what each kind
  // does and what is refused). When the stream stops the vehicle holds. Stamp and sequence are filled in.
  // False if no controller is there.
  bool send(const control::Setpoint& setpoint);

 private:
  Manoeuvre request(const control::Request& request, std::chrono::milliseconds timeout);
  Manoeuvre request_of_mission(std::uint8_t kind, std::uint64_t id, std::chrono::milliseconds timeout);

  std::shared_ptr<Client> client_;
};

}  // namespace swiftlet::ground

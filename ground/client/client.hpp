// The message-level client of one vehicle: receives its topics and sends requests to its controller.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings_request.hpp"
#include "swiftlet/ground/client/ground_heartbeat.hpp"
#include "swiftlet/ground/client/result.hpp"
#include "swiftlet/ground/client/simulation_clock.hpp"
#include "swiftlet/ground/client/telemetry.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

namespace msg = messages::msg;
using Clock = std::chrono::steady_clock;

// The newest sample of a topic.
template <class T>
struct Latest {
  T message{};
  Clock::time_point received{};
  std::uint64_t count = 0;  // samples received

  bool seen() const { return count > 0; }
  double age_s(Clock::time_point now) const { return std::chrono::duration<double>(now - received).count(); }
};

// The newest message of each topic of the vehicle and its controller.
struct View {
  Latest<msg::ControlStatus> control;
  std::int64_t left_mission_ns = 0;  // stamp of the first control_status after those in mode mission
  Latest<msg::MissionStatus> mission;
  Latest<msg::VehicleInfo> vehicle;
  Latest<msg::Battery> battery;
  Latest<msg::Estimate> estimate;
  Latest<msg::Reference> reference;
  Latest<msg::GroundTruth> truth;
  Latest<msg::ClockStatus> clock;    // of motion capture with a clock of its own
  std::map<std::string, int> peers;  // number of live processes, by name
  std::string foreign_control;  // the last control_status had another wire version, a sentence; empty: not so
  std::map<std::uint64_t, Latest<msg::ControllerState>>
      controllers;                               // by controller number; filled after hear_controllers()
  std::shared_ptr<const msg::FlownFiles> files;  // of the active controller; filled after hear_files()
};

// Works on messages. Programs that fly a vehicle use Vehicle (ground/client/vehicle.hpp), which is built on
// this class. Thread-safe.
class Client {
 public:
  // Throws std::runtime_error if the network cannot be joined.
  explicit Client(const dds::NodeSettings& settings);
  // Shares the participant with other clients. settings.vehicle names the vehicle. Without telemetry, of View only
  // control, mission, vehicle and peers are filled.
  Client(const dds::Participant& participant, const dds::NodeSettings& settings,
         Telemetry telemetry = Telemetry::kReceived);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  View view() const;

  // Fills View::controllers from controller_state, which standbys publish too. Call once, from one thread.
  void hear_controllers();
  void hear_files();

  // Publishes the time up to which a lockstep plant that was started paused may advance. The first call
  // starts the publisher.
  SimulationClockPublisher& simulation_clock();
  // A sample of the vehicle with this stamp is in the record of its flight. Once it is told so, this client lets time advance no
  // further than the record follows. From any thread.
  void has_been_recorded(std::int64_t stamp_ns);

  // Publishes the ground heartbeat until the failsafe is disabled or the client is destroyed: if it stops
  // otherwise, the controller does what failsafe.ground_link_action says. Call these two and
  // simulation_clock() from one thread.
  void enable_link_loss_failsafe();
  void disable_link_loss_failsafe();

  // Waits until `done` returns true for the view. Returns false after the time-out. `done` must not call this
  // client.
  bool wait(std::chrono::milliseconds timeout, const std::function<bool(const View&)>& done) const;

  // Sends a request and waits until it is answered, the time-out expires, or `cancelled` returns true.
  // Delivery is reliable. The request is sent again only if another controller may have to answer it, or
  // after 2 s without an answer.
  using Cancelled = std::function<bool()>;
  Result request(const control::Request& request, std::chrono::milliseconds timeout,
                 const Cancelled& cancelled = {});
  Result upload(const control::Mission& mission, std::chrono::milliseconds timeout,
                const Cancelled& cancelled = {});
  Result upload(const control::Trajectory& trajectory, std::chrono::milliseconds timeout,
                const Cancelled& cancelled = {});
  Result change_settings(const control::SettingsRequest& settings, std::chrono::milliseconds timeout,
                         const Cancelled& cancelled = {});
  // Publishes one setpoint of a stream; setpoints are not answered. Fills in stamp and sequence. Returns
  // false if no controller subscribes.
  bool send(control::Setpoint setpoint);
  // Returns when a controller subscribes to setpoints, at the deadline, or when cancelled.
  void await_setpoint_reader(Clock::time_point deadline, const Cancelled& cancelled) const;
  // MissionStatus::mission_id of the mission that this client uploaded last.
  std::uint64_t mission_id() const { return mission_id_; }
  const std::string& vehicle() const { return settings_.vehicle; }
  dds::Node& node() { return node_; }

  // The last reported status of one of this client's last 64 requests. Keeps those that control_status no
  // longer lists. nullopt if none was reported.
  std::optional<msg::RequestStatus> reported_status(const control::RequestKey& request) const;

  // "vehicle kl1 in domain 0; processes found: plant, mocap"
  std::string where() const;
  // An error text: no controller was found, what was found instead, and what to try.
  std::string no_control() const;

 private:
  void note_requests(const msg::ControlStatus& status);
  Client(const dds::Participant* shared, const dds::NodeSettings& settings, Telemetry telemetry);
  template <class T>
  void keep(Latest<T> View::*slot, const T& message);
  void subscribe_statuses();
  void subscribe_telemetry();
  void advance_after(std::int64_t stamp_ns);
  void advance();
  template <class T>
  T numbered(T message);
  template <class T>
  Result ask(dds::Publisher<T>& publisher, const T& request, std::chrono::milliseconds timeout,
             const Cancelled& cancelled);

  dds::NodeSettings settings_;
  std::uint64_t client_id_;
  std::atomic<std::uint64_t> last_id_;  // random start: mission ids of two tools must differ
  std::atomic<std::uint64_t> mission_id_{0};

  mutable std::mutex mutex_;  // guards view_, answers_, reported_ and the pointers below; held briefly
  mutable std::condition_variable changed_;
  View view_;
  std::map<std::uint64_t, std::optional<Result>> answers_;  // of pending requests, by id
  std::uint64_t takeovers_ = 0;                             // seen in control_status
  std::map<std::uint64_t, msg::RequestStatus> reported_;    // of this client's requests, by id

  dds::Node node_;
  dds::Publisher<msg::Command> commands_;
  dds::Publisher<msg::Mission> missions_;
  dds::Publisher<msg::Trajectory> trajectories_;
  dds::Publisher<msg::ControlSettings> settings_changes_;
  dds::Publisher<msg::Setpoint> setpoints_;
  std::mutex sending_;  // guards all publishers
  std::uint64_t setpoint_count_ = 0;
  // Created, used and destroyed without mutex_ held: the middleware's threads lock mutex_ in callbacks while
  // they hold the middleware's own locks (deadlock).
  std::shared_ptr<SimulationClockPublisher> clock_publisher_;
  std::atomic<std::int64_t> come_ns_{0};       // the newest stamp that has arrived here
  std::atomic<std::int64_t> recorded_ns_{-1};  // and in the record; < 0: there is none
  std::shared_ptr<GroundHeartbeatPublisher> heartbeat_;
  std::vector<dds::Subscription> subscriptions_;  // last: their callbacks use all members above
};

// Names of the messages' constants.
const char* mode_name(std::uint8_t mode);
const char* pose_fault_name(std::uint8_t fault);  // "none", "frozen" ...
const char* mission_state_name(std::uint8_t state);

}  // namespace swiftlet::ground

// The ground's end of the wire to one vehicle: hears what it says of itself and asks things of it.
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
#include "swiftlet/ground/client/ground_heartbeat.hpp"
#include "swiftlet/ground/client/result.hpp"
#include "swiftlet/ground/client/simulation_clock.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

namespace msg = comms::msg;
using Clock = std::chrono::steady_clock;

// The newest sample of a topic.
template <class T>
struct Latest {
  T message{};
  Clock::time_point received{};
  std::uint64_t count = 0;  // of the samples that came

  bool seen() const { return count > 0; }
  double age_s(Clock::time_point now) const { return std::chrono::duration<double>(now - received).count(); }
};

// What has come of the samples, where they are recorded.
struct HeardSamples {
  bool imu = false;
  bool command = false;
  bool pose = false;  // or the sign of motion capture that it is there

  bool all() const { return imu && command && pose; }
};

// What the vehicle and its controller have said.
struct View {
  Latest<msg::ControlStatus> control;
  Latest<msg::MissionStatus> mission;
  Latest<msg::VehicleInfo> vehicle;
  Latest<msg::Battery> battery;
  Latest<msg::Estimate> estimate;
  Latest<msg::Reference> reference;
  Latest<msg::GroundTruth> truth;
  HeardSamples samples;
  std::map<std::string, int> peers;  // by name: how many are alive
  std::map<std::uint64_t, Latest<msg::ControllerState>>
      controllers;  // by number; once hear_controllers() was called
};

// The wire itself, as messages; a program that flies a vehicle uses Vehicle (ground/client/vehicle.hpp), which
// stands on it. Any thread may call it.
class Client {
 public:
  // record: where every sample of truth, reference, estimate and mission status is kept, and, if it has room
  // for them, what was sensed and commanded; may be null. Throws std::runtime_error if the network cannot be
  // joined.
  explicit Client(const comms::NodeSettings& settings, FlightRecord* record = nullptr);
  // One of those that share the participant; settings.vehicle says which.
  Client(const comms::Participant& participant, const comms::NodeSettings& settings);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  View view() const;

  // From now on the view holds what the controllers say of themselves, the standbys too. Once, by one thread.
  void hear_controllers();

  // For a plant in lockstep that was started paused: from the first call on, this client grants it time.
  SimulationClockPublisher& simulation_clock();

  // From now on the flight depends on this client: if it falls silent, the controller does what its settings
  // say. Until leave() or the client's end. One thread calls these and grants().
  void enable_link_loss_failsafe();
  void disable_link_loss_failsafe();

  // Waits until `done` holds of the view; false if it does not within the time-out. `done` must not call this
  // client.
  bool wait(std::chrono::milliseconds timeout, const std::function<bool(const View&)>& done) const;

  // Waits until it is answered, the time is over, or `cancelled` says so. Delivery is the network's task: it
  // is sent again where another controller may have to answer, and after 2 s without an answer.
  using Cancelled = std::function<bool()>;
  Result command(msg::Command command, std::chrono::milliseconds timeout, const Cancelled& cancelled = {});
  Result upload(const control::Mission& mission, std::chrono::milliseconds timeout,
                const Cancelled& cancelled = {});
  Result upload(const control::Trajectory& trajectory, std::chrono::milliseconds timeout,
                const Cancelled& cancelled = {});
  // One of a stream, for which there is no answer: stamp and number are filled in. False if nobody is there
  // to take it.
  bool send(control::Setpoint setpoint);
  // One of Command_Constants::MISSION_*, of the mission of this id; 0: of whichever is there.
  Result mission_command(std::uint8_t kind, std::uint64_t mission_id, std::chrono::milliseconds timeout,
                         const Cancelled& cancelled = {});
  // Of the mission uploaded last: MissionStatus::mission_id.
  std::uint64_t mission_id() const { return mission_id_; }
  const std::string& vehicle() const { return settings_.vehicle; }

  // What was told last of a request of this client, also of one that newer requests have pushed out of the status:
  // of the last 64.
  std::optional<msg::RequestStatus> reported_status(const control::RequestKey& request) const;

  // "vehicle kl1 in domain 0; seen there: plant, mocap"
  std::string where() const;
  // That none was found there, what was, and what to do about it.
  std::string no_control() const;

 private:
  void note_requests(const msg::ControlStatus& status);
  Client(const comms::Participant* shared, const comms::NodeSettings& settings, FlightRecord* record);
  template <class T>
  void keep(Latest<T> View::*slot, const T& message);
  void subscribe_all();
  void subscribe_sensors(SensorRecord& sensors);
  void note_heard(bool HeardSamples::*kind);
  void grant_after(std::int64_t stamp_ns);
  template <class T>
  Result ask(comms::Publisher<T>& publisher, const T& request, std::chrono::milliseconds timeout,
             const Cancelled& cancelled);

  comms::NodeSettings settings_;
  FlightRecord* record_;
  std::uint64_t client_id_;
  std::atomic<std::uint64_t> last_id_;  // starts at random: mission ids of two tools must differ
  std::atomic<std::uint64_t> mission_id_{0};

  mutable std::mutex mutex_;  // guards view_, answers_, told_ and the pointers below; held for copies only
  mutable std::condition_variable changed_;
  View view_;
  std::map<std::uint64_t, std::optional<Result>> answers_;  // to the requests under way, by id
  std::uint64_t takeovers_ = 0;                             // that control_status told of
  std::map<std::uint64_t, msg::RequestStatus> reported_;    // of this client's requests, by id

  comms::Node node_;
  comms::Publisher<msg::Command> commands_;
  comms::Publisher<msg::Mission> missions_;
  comms::Publisher<msg::Trajectory> trajectories_;
  comms::Publisher<msg::Setpoint> setpoints_;
  std::mutex sending_;  // of all publishers
  std::uint64_t setpoint_count_ = 0;
  // Made, used and destroyed without mutex_: the middleware's threads hold its locks when they ask for that.
  std::shared_ptr<SimulationClockPublisher> grants_;
  std::shared_ptr<GroundHeartbeatPublisher> heartbeat_;
  std::vector<comms::Subscription> subscriptions_;  // last: their callbacks use all of the above
};

// Words for the constants of the wire.
const char* mode_name(std::uint8_t mode);
const char* pose_fault_name(std::uint8_t fault);  // "none", "frozen" ...
const char* mission_state_name(std::uint8_t state);

}  // namespace swiftlet::ground

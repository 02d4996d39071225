// Flies one mission to its end, whatever flies it: a vehicle on the network, a loop in this process, or supervision
// alone in a dry run.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::simulation {

// Why a flight did not come to its end. what() is a sentence.
class FlightFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// When a flight does what, on the vehicle's clock. Lockstep over DDS and a loop in one process keep to it to the
// nanosecond and so fly the same flight.
struct FlightSchedule {
  static constexpr std::int64_t kFirstRequestNs = 1'000'000'000;  // the estimator has settled
  static constexpr std::int64_t kArmingRetryNs =
      200'000'000;  // between a refusal to arm and the next request
  static constexpr std::int64_t kArmingTimeoutNs = 5'000'000'000;  // from the first request
  // After a mission was aborted: the vehicle is asked to land if by then it neither lands nor descends of itself. Looked
  // at again as much later.
  static constexpr std::int64_t kLandAfterNs = 5'000'000'000;
  static constexpr double kLandingSpeed = 0.4;  // m/s
  static constexpr double kLandingTimeoutS = 30.0;

  // From the start of the mission.
  static double time_limit_s(double planned_duration_s) { return 1.5 * planned_duration_s + 30.0; }
};

// What the runner needs of the vehicle. Each method may throw FlightFailure, which ends the flight.
class MissionTransport {
 public:
  struct Reply {
    bool accepted = false;
    bool retry = false;  // refused, for a reason that may pass
    std::string reason;  // a sentence, unless accepted
  };
  struct Status {
    std::int64_t stamp_ns = 0;                                     // on the vehicle's clock
    control::MissionState mission = control::MissionState::kNone;  // of the mission that is flown
    bool rotors_off = false;
  };

  MissionTransport() = default;
  virtual ~MissionTransport() = default;
  MissionTransport(const MissionTransport&) = delete;
  MissionTransport& operator=(const MissionTransport&) = delete;

  virtual void wait_until_ready() = 0;  // for the first request
  virtual Reply arm() = 0;
  virtual Reply start_mission() = 0;  // uploads the mission and starts it
  virtual void wait(std::int64_t duration_ns, const std::string& reason) = 0;
  virtual void wait_for_other_vehicles() {}  // all are armed
  virtual void advance() = 0;                // by a step, or until there is news
  virtual Status status() const = 0;
  virtual std::string abort_reason() const = 0;  // of an aborted mission
  // Ends the flight of a vehicle that is armed or flies, and leaves it disarmed. Throws FlightFailure.
  [[noreturn]] virtual void abandon(const std::string& reason) { throw FlightFailure(reason); }
};

// Whether the vehicle comes to the ground without being asked.
bool comes_down(control::Mode mode);
// "landed": how an abandoned flight ended, by the mode in which the rotors are off.
std::string end_of(control::Mode mode, bool has_flown);

// Waits, arms, starts the mission and follows it until it is completed and the rotors are off. Throws
// FlightFailure. planned_duration_s bounds the time that the mission may take.
void fly_mission(MissionTransport& vehicle, double planned_duration_s);

}  // namespace swiftlet::simulation

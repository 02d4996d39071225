// A flight in which one of its four processes is killed, hangs for a time, or is started again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/plant/model/control_level.hpp"

namespace swiftlet::soak {

enum class FlightProcess { kPlant, kMocap, kControl, kGround };
enum class ProcessFailure {
  kKilled,     // and it stays dead
  kHung,       // stopped by SIGSTOP, and continued after kProcessAway_s
  kRestarted,  // killed, and started again after kProcessAway_s
};
constexpr double kProcessAway_s = 1.5;

enum class Fate {
  kFliesOn,   // the mission goes on
  kLands,     // with a failsafe, or by the ground
  kFalls,     // the rotors stop in flight
  kGone,      // the vehicle itself is gone; control commands nothing any more
  kStaysOff,  // the vehicle starts again, and its rotors stay off
};
const char* to_string(Fate fate);

// A row of the table in docs/bad-links.md.
struct ProcessCase {
  FlightProcess process;
  ProcessFailure failure;
  plant::ControlLevel level;
  Fate expected;

  std::string name() const;  // "control hung, level rates"
};
const std::vector<ProcessCase>& process_cases();

struct ProcessResult {
  std::optional<Fate> fate;  // nullopt: none of them
  std::string reason;        // of the last mode of control; empty: it is dead
  double climb_m = 0.0;      // above the mission's height, from the failure on
  double sideways_m = 0.0;   // from the square of the mission, as long as the vehicle is in the air
  std::string ground_fault;  // of a ground that was started again: why it does not fly the vehicle
};

// A vehicle that is left alone climbs no higher than this: what the speed of the path and 0.2 s of an old command give.
constexpr double kMostClimb_m = 0.3;

// Starts all processes in a domain of its own, flies laps of a square, and lets one process fail in flight; likewise for each
// further case, with the processes that live on and new ones for the dead. All cases have one level. speed: of the simulation.
// Programs write their output into the folder. Throws std::runtime_error if a flight does not begin.
std::vector<ProcessResult> fly_with_failures(const std::vector<ProcessCase>& cases,
                                             const std::filesystem::path& folder, double speed = 1.0);

}  // namespace swiftlet::soak

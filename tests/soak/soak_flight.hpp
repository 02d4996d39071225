// A soak flight: a sampled vehicle and world, a random pilot, random faults, and the invariants that must
// hold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"
#include "swiftlet/simulation/dispersion.hpp"
#include "tests/soak/pilot.hpp"

namespace swiftlet::soak {

// Vehicle, world and settings. The controller is designed on nominal.vehicle.
struct SoakSetup {
  simulation::World nominal;
  simulation::Dispersion dispersion;
  control::ControlSettings control;
};
// Loads vehicle "kaylion", simulation "default" and the control settings of this name.
SoakSetup load_setup(const std::string& control);

// The invariant: truth is at most kFenceMargin_m outside the fence at every IMU stamp, and the vehicle is
// never upside down with its rotors running for longer than kUpsideDown_s, nor at the end of the flight.
constexpr double kFenceMargin_m = 0.5;
constexpr double kUpsideDown_s = 1.0;

struct Violation {
  double at_s = 0.0;
  std::string what;  // "0.52 m outside the fence"
};

// Consequence of a fault: the most severe action of the controller or event of the vehicle from the fault's
// start to 1 s after its end. Overlapping faults have the same consequences.
enum class Consequence : std::uint8_t { kOnGround, kFlewOn, kLanded, kDescended, kStopped, kFell };
constexpr int kConsequences = static_cast<int>(Consequence::kFell) + 1;

struct MetFault {
  plant::Fault fault;
  Consequence consequence = Consequence::kOnGround;
};

struct SoakFlight {
  std::uint64_t seed = 0;
  double simulated_s = 0.0;
  double airborne_s = 0.0;
  int take_offs = 0;
  double most_outside_m = 0.0;  // the fence
  bool lies = false;            // ended tilted on the ground, so that it cannot be armed
  std::vector<MetFault> faults;
  std::optional<Violation> violation;  // the first one; it ends the flight
};

// Flies the flight of a seed: 120 s unless it ends earlier. Logs events to `log`, if given.
SoakFlight fly(const SoakSetup& setup, std::uint64_t seed, const Log& log = {});

}  // namespace swiftlet::soak

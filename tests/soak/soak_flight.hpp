// A flight of the soak: a drawn vehicle in a drawn world, a pilot who asks for this and that, faults of all
// kinds, and what must hold whatever they do.
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

// What is flown with. The controller is designed on nominal.vehicle.
struct SoakSetup {
  ground::World nominal;
  ground::Dispersion dispersion;
  control::ControlSettings control;
};
// The files "kaylion" and "default", and the control settings of that name.
SoakSetup load_setup(const std::string& control);

// The invariant: truth is at most kFenceMargin_m outside the fence at every IMU stamp, and the vehicle is
// never upside down with its rotors running for longer than kUpsideDown_s, nor at the end of the flight.
constexpr double kFenceMargin_m = 0.5;
constexpr double kUpsideDown_s = 1.0;

struct Violation {
  double at_s = 0.0;
  std::string what;  // "0.52 m outside the fence"
};

// What came of a fault: the gravest that the controller did by itself, or that happened to the vehicle, from
// the fault's beginning to a second after its end. Faults that overlap are told the same.
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
  bool lies = false;            // it ended on the ground, not on its feet: nobody can arm it any more
  std::vector<MetFault> faults;
  std::optional<Violation> violation;  // the first; ends the flight
};

// The flight of a seed; of 120 s unless it ends before. `log`, if there is one, is told what happens.
SoakFlight fly(const SoakSetup& setup, std::uint64_t seed, const Log& log = {});

}  // namespace swiftlet::soak

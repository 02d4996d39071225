// A flight in one process with the files of the repository, to be changed.
#pragma once

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::tests {

struct FlightSetup {
  plant::Vehicle nominal = io::load_vehicle(io::find_config("vehicles/kaylion.yaml"));
  plant::Vehicle flown = nominal;  // of which the controller does not know
  plant::SimulationSettings simulation =
      io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  control::ControlSettings control = io::load_control_settings(io::find_config("control/motor_lag.yaml"));
};

}  // namespace swiftlet::tests

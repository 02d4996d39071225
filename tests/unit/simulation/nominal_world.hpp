// The nominal world of the dispersion tests.
#pragma once

#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/dispersion.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::simulation {

inline const World& nominal() {
  static const World world{io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")),
                           io::load_simulation_settings(tests::in_source("config/simulation/default.yaml"))};
  return world;
}

}  // namespace swiftlet::simulation

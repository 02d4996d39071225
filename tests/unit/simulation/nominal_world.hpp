// The nominal world of the dispersion tests.
#pragma once

#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::ground {

inline const World& nominal() {
  static const World world{
      runtime::load_vehicle(SWIFTLET_SOURCE_DIR "/config/vehicles/kaylion.yaml"),
      runtime::load_simulation_settings(SWIFTLET_SOURCE_DIR "/config/simulation/default.yaml")};
  return world;
}

}  // namespace swiftlet::ground

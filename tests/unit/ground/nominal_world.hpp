// What variations start from in the tests.
#pragma once

#include "swiftlet/ground/simulation/variation.hpp"
#include "swiftlet/services/runtime/simulation_file.hpp"
#include "swiftlet/services/runtime/vehicle_file.hpp"

namespace swiftlet::ground {

inline const World& nominal() {
  static const World world{
      runtime::load_vehicle(SWIFTLET_SOURCE_DIR "/config/vehicles/kaylion.yaml"),
      runtime::load_simulation_settings(SWIFTLET_SOURCE_DIR "/config/simulation/default.yaml")};
  return world;
}

}  // namespace swiftlet::ground

// What is known of a vehicle whose processes run already, which others may command too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Throws std::runtime_error with a sentence if a vehicle is in flight. Likewise if no process of it is found
// within 5 s, or only a control service that cannot be heard. Returns if other processes are found: control may
// still be starting. Returns what each vehicle reports within 1 s.
struct StandingVehicle {
  std::optional<ReportedModel> model;
  std::optional<Eigen::Vector2d> start_ned;  // m, where it stands
};
std::vector<StandingVehicle> require_on_ground(const dds::NodeSettings& network,
                                               const std::vector<std::string>& vehicles);

// What a vehicle model is known by.
struct KnownVehicle {
  std::optional<plant::Vehicle> model;
  std::string unknown;  // why there is none, a sentence
};

// The vehicle in the configuration with the name that the running one reports, if mass and number of rotors agree. Throws
// io::ConfigError if its file is invalid.
KnownVehicle known_vehicle(const std::optional<ReportedModel>& reported);

}  // namespace swiftlet::ground

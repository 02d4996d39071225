// What is known of a vehicle whose processes run already, which others may command too.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/ground/flight/running_files.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

struct StandingVehicle {
  std::unique_ptr<RunningFiles> files;       // that its controller flies with
  std::optional<Eigen::Vector2d> start_ned;  // m, where it stands; nullopt: not reported within 1 s
};

// Throws std::runtime_error with a sentence if a vehicle is in flight, or if no process of it is found within 5 s, or no control
// service that can be heard and tells its files.
std::vector<StandingVehicle> require_on_ground(const dds::NodeSettings& network,
                                               const std::vector<std::string>& vehicles);

}  // namespace swiftlet::ground

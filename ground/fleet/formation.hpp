// Vehicles that hover, moved as one or landed together: where each goes, and whether all stay apart on the way. Pure logic.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/fleet/separation.hpp"

namespace swiftlet::ground {

struct FormationVehicle {
  std::string name;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m, where it hovers or stands
  bool flies = false;                                      // else it stands on the ground
  bool is_member = false;                                  // of the formation; members fly
};

// How the members move: straight, as `goto` does.
struct FormationMove {
  double speed = 0.5;      // m/s, peak
  control::Limits limits;  // of all members
  double skew_s = 0.5;     // by which one may begin later than another
};

// m NED, of each vehicle: where it goes when the centre of the members, the mean of their positions, goes to centre_ned. All
// keep their offsets. Those that are no members stay.
std::vector<Eigen::Vector3d> formation_targets(const std::vector<FormationVehicle>& vehicles,
                                               const Eigen::Vector3d& centre_ned);

// Why they must not go there, one sentence; empty if they may: ellipsoids touch on the way, also if one begins skew_s later than
// another.
std::string formation_refusal(const std::vector<FormationVehicle>& vehicles,
                              const std::vector<Eigen::Vector3d>& targets_ned, const FormationMove& move,
                              const Ellipsoid& safety);

// s: by which one may begin later than another without such a refusal, between move.skew_s, at which there is none, and longest_s.
double longest_skew_s(const std::vector<FormationVehicle>& vehicles,
                      const std::vector<Eigen::Vector3d>& targets_ned, FormationMove move,
                      const Ellipsoid& safety, double longest_s);

// For each vehicle another one on whose place it would come down if it landed straight, that stands there or flies lower.
std::vector<std::optional<std::size_t>> landing_obstacles(const std::vector<FormationVehicle>& vehicles,
                                                          const Ellipsoid& safety);

}  // namespace swiftlet::ground

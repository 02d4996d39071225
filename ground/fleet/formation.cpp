#include "swiftlet/ground/fleet/formation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/ground/fleet/flight_path.hpp"

namespace swiftlet::ground {
namespace {

using Eigen::Vector3d;

constexpr double kShortestMove_s = 0.5;  // of control/guidance
constexpr double kLower_m = 0.05;
constexpr double kSkewStep_s = 0.01;

// Rests for a while, then moves as `goto` does.
FlightPath path_of(const Vector3d& from_ned, const Vector3d& to_ned, const FormationMove& move,
                   double rests_s) {
  const double duration_s = control::minimum_jerk_duration((to_ned - from_ned).norm(), move.speed,
                                                           move.limits.max_reference_acceleration,
                                                           move.limits.max_reference_jerk, kShortestMove_s);
  std::vector<FlightPath::Piece> pieces;
  if (rests_s > 0.0) pieces.push_back({0.0, control::minimum_jerk(from_ned, 0.0, from_ned, 0.0, rests_s)});
  pieces.push_back({rests_s, control::minimum_jerk(from_ned, 0.0, to_ned, 0.0, duration_s)});
  return FlightPath(std::move(pieces));
}

}  // namespace

std::vector<Vector3d> formation_targets(const std::vector<FormationVehicle>& vehicles,
                                        const Vector3d& centre_ned) {
  Vector3d sum = Vector3d::Zero();
  int members = 0;
  for (const FormationVehicle& vehicle : vehicles) {
    if (!vehicle.is_member) continue;
    sum += vehicle.position_ned;
    ++members;
  }
  const Vector3d move = centre_ned - sum / std::max(members, 1);
  std::vector<Vector3d> targets;
  for (const FormationVehicle& vehicle : vehicles)
    targets.push_back(vehicle.is_member ? Vector3d(vehicle.position_ned + move) : vehicle.position_ned);
  return targets;
}

std::string formation_refusal(const std::vector<FormationVehicle>& vehicles,
                              const std::vector<Vector3d>& targets_ned, const FormationMove& move,
                              const Ellipsoid& safety) {
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    for (std::size_t j = 0; j < vehicles.size(); ++j) {
      if (i == j || !vehicles[i].is_member) continue;
      const FlightPath first = path_of(vehicles[i].position_ned, targets_ned[i], move, 0.0);
      const FlightPath later = path_of(vehicles[j].position_ned, targets_ned[j], move, move.skew_s);
      const Approach closest = closest_approach(first, safety, later, safety);
      if (closest.clearance >= 1.0) continue;
      const Vector3d apart = closest.b_ned - closest.a_ned;
      return fmt::format(
          "{} would come too near to {}: {:.2f} m across and {:.2f} m in height, at ({:.2f}, {:.2f}, {:.2f}) "
          "m NED; they must "
          "be {:.2f} m apart across, or {:.2f} m in height",
          vehicles[i].name, vehicles[j].name, apart.head<2>().norm(), std::abs(apart.z()), closest.a_ned.x(),
          closest.a_ned.y(), closest.a_ned.z(), 2.0 * safety.radius_xy_m, 2.0 * safety.radius_z_m);
    }
  }
  return "";
}

// Bisects: all move by the same way, so the later one begins, the further it is behind.
double longest_skew_s(const std::vector<FormationVehicle>& vehicles, const std::vector<Vector3d>& targets_ned,
                      FormationMove move, const Ellipsoid& safety, double longest_s) {
  double allowed_s = move.skew_s;
  double refused_s = longest_s;
  move.skew_s = longest_s;
  if (longest_s > allowed_s && formation_refusal(vehicles, targets_ned, move, safety).empty())
    return longest_s;
  while (refused_s - allowed_s > kSkewStep_s) {
    move.skew_s = 0.5 * (allowed_s + refused_s);
    const bool may = formation_refusal(vehicles, targets_ned, move, safety).empty();
    (may ? allowed_s : refused_s) = move.skew_s;
  }
  return allowed_s;
}

std::vector<std::optional<std::size_t>> landing_obstacles(const std::vector<FormationVehicle>& vehicles,
                                                          const Ellipsoid& safety) {
  std::vector<std::optional<std::size_t>> obstacles(vehicles.size());
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    for (std::size_t j = 0; j < vehicles.size() && vehicles[i].flies; ++j) {
      const Vector3d apart = vehicles[j].position_ned - vehicles[i].position_ned;
      const bool is_lower = !vehicles[j].flies || apart.z() > kLower_m;
      if (i != j && is_lower && apart.head<2>().norm() < 2.0 * safety.radius_xy_m) obstacles[i] = j;
    }
  }
  return obstacles;
}

}  // namespace swiftlet::ground

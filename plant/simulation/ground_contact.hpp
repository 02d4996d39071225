// Contact of a rigid vehicle with a level floor. Contact points are a foot under each rotor, and each hub for
// a vehicle that lies on its back.
//
// There are no springs. Moreau's time stepping applies an impulse at each touching point at the end of a
// step, such that no point moves into the floor, the floor does not pull, and friction stays within Coulomb's
// cone. Projected Gauss-Seidel solves for the impulses. Impacts are inelastic. The method is stable at any
// step and adds no energy.
#pragma once

#include <array>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

class GroundContact {
 public:
  GroundContact(const Vehicle& vehicle, const GroundSettings& settings);

  struct ContactState {
    Eigen::Vector3d position_ned;  // m
    Eigen::Quaterniond q_ned_from_frd;
  };

  // True if a vehicle whose origin is at this height cannot touch the floor in any attitude. No other call is
  // then needed.
  bool out_of_reach(double position_z_ned) const { return position_z_ned + reach_ < floor_z_; }

  // Applies contact to a step of free flight of length dt, s, from `before` to `after`, and corrects `after`.
  // Returns true if the floor carries load; acceleration_ned is then its contribution to the body's mean
  // acceleration over the step, m/s^2.
  bool resolve(const ContactState& before, VehicleState& after, double dt, Eigen::Vector3d& acceleration_ned);

  // Height of the floor, m NED (down is positive): the leg height.
  double floor_z_ned() const { return floor_z_; }
  // Distance from the lowest contact point down to the floor, m; negative if it is below the floor.
  double clearance(const VehicleState& state) const;

 private:
  struct Point {
    Eigen::Vector3d arm_ned;       // m, from the origin
    double gap;                    // m, distance to the floor
    bool has_inertia;              // turn and inverse_mass are valid for this step
    Eigen::Matrix3d turn;          // rad/s per N s, angular velocity change per impulse
    Eigen::Vector3d inverse_mass;  // 1/kg, velocity change of the point per impulse along each axis
    Eigen::Vector3d impulse;       // N s, in NED; the next step's solution starts from it
  };

  static constexpr int kMaxPoints = 2 * kMaxRotors;

  bool present_;
  double floor_z_;
  double reach_ = 0.0;
  double friction_;
  double mass_;
  Eigen::Matrix3d inverse_inertia_;
  int point_count_;
  std::array<Eigen::Vector3d, kMaxPoints> points_frd_;
  std::array<Point, kMaxPoints> points_{};
};

}  // namespace swiftlet::plant

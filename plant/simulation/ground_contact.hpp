// A level floor under a rigid vehicle: feet under the rotors, and the hubs for one that lies on its back.
//
// No springs: an impulse at each touching point ends every step, such that no point moves into the floor,
// none is held by it, and friction stays within Coulomb's cone (Moreau's time stepping; the impulses by
// projected Gauss-Seidel). Impacts are inelastic. It is stable at any step and adds no energy.
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

  // Nothing of the vehicle can be on the floor with its origin at this height: no need to ask further.
  bool out_of_reach(double position_z_ned) const { return position_z_ned + reach_ < floor_z_; }

  // Corrects a step of free flight to after that took dt, from where the vehicle was before. Returns true
  // if the floor bore load; then acceleration_ned is what it added to the body's acceleration over the
  // step, m/s^2.
  bool resolve(const ContactState& before, VehicleState& after, double dt, Eigen::Vector3d& acceleration_ned);

  // m NED, of the floor, down from the origin: the leg height.
  double floor_z_ned() const { return floor_z_; }
  // m, from the lowest point of the vehicle down to the floor; negative: it is in the floor.
  double clearance(const VehicleState& state) const;

 private:
  struct Point {
    Eigen::Vector3d arm_ned;       // from the origin
    double gap;                    // m, to the floor
    bool has_inertia;              // the next two are those of this step
    Eigen::Matrix3d turn;          // angular velocity over impulse
    Eigen::Vector3d inverse_mass;  // velocity over impulse, along each axis
    Eigen::Vector3d impulse;       // N s, in NED; kept from step to step, where the next solution starts
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

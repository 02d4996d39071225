// Allocation: the identified model inverted. Wanted thrust and moments, at the measured supply voltage,
// become one throttle for each rotor: wrench -> thrusts (27)(28) -> speeds (25) -> v_a (22) -> delta (9).
#pragma once

#include <Eigen/Core>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

struct Wrench {
  double thrust_n = 0.0;                                 // sum of the rotors', along -z of FRD
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();  // N m: u1 .. u3
};

struct Allocation {
  plant::PerRotor throttle{};  // delta of Eq. (8), 0 .. 1
  plant::PerRotor thrust_n{};  // what each rotor will hold, N
  bool saturated = false;      // together they do not give what was wanted
  bool invalid_input = false;  // something was not finite, or the supply not plausible; see allocate
};

class Allocator {
 public:
  // Throws std::invalid_argument with a sentence if the rotors cannot give thrust and all three moments, or
  // the vehicle has no battery table.
  explicit Allocator(const plant::Vehicle& vehicle);

  // What a supply voltage lets one rotor give. A voltage that is not finite or outside plausible_supply()
  // counts as the middle of the battery's open-circuit voltages.
  struct Supply {
    double highest_thrust_n = 0.0;     // at throttle 1
    double throttle_per_square = 0.0;  // V^-2: of v_a^2 less the offset, Eq. (9) backwards
    bool plausible = false;
  };
  Supply supply_at(double supply_voltage_v) const;

  // Thrusts by the pseudo-inverse of the effectiveness: the exact solution with four rotors, the one of least
  // squares with more. Each rotor stays between its thrusts at throttle 0 (which is not zero thrust) and 1 at
  // this supply voltage. Where the wanted wrench does not fit, within the pseudo-inverse's solutions:
  //   1. roll and pitch moment are kept, whatever thrust and yaw that takes; if even that does not do, both
  //      are scaled by one factor, the largest that fits;
  //   2. thrust then comes as near to the wanted one as it can, whatever yaw that takes;
  //   3. yaw moment then comes as near as it can.
  // Total: the result is finite and within limits for every input. A moment that is not finite counts as 0, a
  // thrust that is not finite as the vehicle's weight; each, and a supply that is not plausible, sets
  // invalid_input.
  Allocation allocate(const Wrench& wanted, const Supply& supply) const;

  // What rotors that hold these thrusts give together.
  Wrench wrench(const plant::PerRotor& thrust_n) const;

  // Half the empty battery's voltage .. one and a half times the full one's, V.
  struct SupplyRange {
    double min = 0.0;
    double max = 0.0;
    double assumed = 0.0;
  };
  const SupplyRange& plausible_supply() const { return plausible_; }

 private:
  struct Interval {
    double low;
    double high;
  };
  // An interval of thrust at one scale of roll and pitch, and how its ends move with that scale.
  struct ThrustInterval {
    Interval at;
    Interval slope;
  };

  template <int kCount>
  Allocation allocate_to(const Wrench& wanted, const Supply& supply) const;
  double thrust_at(double supply_voltage_v, double throttle) const;
  bool within_bound(const Wrench& wanted) const;
  Wrench sanitised(const Wrench& wanted, bool& invalid) const;
  plant::PerRotor fitted(const Wrench& wanted, const plant::PerRotor& tilt, const Interval& limits) const;
  template <typename Visit>
  void visit_thrust_bounds(const plant::PerRotor& tilt, const Interval& limits, Visit&& visit) const;
  ThrustInterval thrust_interval(double scale, const plant::PerRotor& tilt, const Interval& limits) const;
  double largest_scale(const plant::PerRotor& tilt, const Interval& limits) const;
  Interval yaw_interval(double scale, double thrust, const plant::PerRotor& tilt,
                        const Interval& limits) const;
  static double nearest(double wanted, const Interval& interval);

  plant::Esc esc_;
  plant::Motor motor_;
  plant::RotorCoefficients rotor_;
  plant::Effectiveness effectiveness_;
  int count_ = 0;
  double weight_n_ = 0.0;
  double idle_thrust_n_ = 0.0;      // of one rotor at throttle 0
  double square_per_thrust_ = 0.0;  // Omega^2 over thrust, Eq. (25) backwards
  SupplyRange plausible_;
  Wrench bound_;  // beyond what any plausible supply can give

  // Columns of the pseudo-inverse: thrust of each rotor for 1 N, and for 1 N m about each axis.
  plant::PerRotor for_thrust_{}, for_roll_{}, for_pitch_{}, for_yaw_{};
  // Where yaw moves a rotor's thrust: 1 / for_yaw and for_thrust / for_yaw. Elsewhere both are 0.
  plant::PerRotor per_yaw_{}, thrust_per_yaw_{};
};

}  // namespace swiftlet::control

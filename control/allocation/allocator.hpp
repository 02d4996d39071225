// Allocation: the inverse of the identified model. Desired thrust and moments, at the measured supply
// voltage, become a throttle per rotor: wrench -> thrusts (27)(28) -> speeds (25) -> v_a (22) -> delta (9).
#pragma once

#include <Eigen/Core>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

struct Wrench {
  double thrust_n = 0.0;                                 // sum over the rotors, along -z of FRD
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();  // N m: u1 .. u3
};

struct Allocation {
  plant::PerRotor throttle{};  // delta of Eq. (8), 0 .. 1
  plant::PerRotor thrust_n{};  // steady thrust of each rotor, N
  bool saturated = false;      // the rotors together do not give the desired wrench
  bool invalid_input = false;  // an input was not finite, or the supply not plausible; see allocate
};

class Allocator {
 public:
  // Throws std::invalid_argument with a sentence if the rotors cannot give thrust and all three moments, or
  // the vehicle has no battery table.
  explicit Allocator(const plant::Vehicle& vehicle);

  // The limits of one rotor at a supply voltage. A voltage that is not finite or outside plausible_supply()
  // is replaced by the middle of the battery's open-circuit voltages.
  struct Supply {
    double highest_thrust_n = 0.0;     // at throttle 1
    double throttle_per_square = 0.0;  // V^-2: of v_a^2 minus the offset, inverse of Eq. (9)
    bool plausible = false;
  };
  Supply supply_at(double supply_voltage_v) const;

  // Thrusts by the pseudo-inverse of the effectiveness: the exact solution for four rotors, least squares
  // for more. Each rotor stays between its thrusts at throttle 0 (which is not zero thrust) and 1 at this
  // supply voltage. If the desired wrench does not fit, within the solutions of the pseudo-inverse:
  //   1. roll and pitch moment are kept at the expense of thrust and yaw; if even that does not suffice, both
  //      are scaled by one factor, the largest that fits;
  //   2. thrust comes as near to the desired one as possible, at the expense of yaw;
  //   3. yaw moment comes as near to the desired one as possible.
  // The result is finite and within limits for every input. A moment that is not finite counts as 0, a
  // thrust that is not finite as the vehicle's weight. Each of these, and a supply that is not plausible,
  // sets invalid_input.
  Allocation allocate(const Wrench& wanted, const Supply& supply) const;

  // The wrench of rotors at these thrusts.
  Wrench wrench(const plant::PerRotor& thrust_n) const;

  // From half the empty battery's voltage to one and a half times the full one's, V.
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
  // An interval of thrust at one scale of roll and pitch, and the slope of its ends over that scale.
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
  double square_per_thrust_ = 0.0;  // Omega^2 over thrust, inverse of Eq. (25)
  SupplyRange plausible_;
  Wrench bound_;  // bound of the wrench at any plausible supply

  // Columns of the pseudo-inverse: thrust of each rotor for 1 N, and for 1 N m about each axis.
  plant::PerRotor for_thrust_{}, for_roll_{}, for_pitch_{}, for_yaw_{};
  // For rotors whose thrust yaw changes: 1 / for_yaw and for_thrust / for_yaw. For others both are 0.
  plant::PerRotor per_yaw_{}, thrust_per_yaw_{};
};

}  // namespace swiftlet::control

// The equations that a flight's log is fitted with, and which of their parameters the log can tell.
//
//   specific force   f = (0, 0, -s T / m) - (c / m) V_b + b                                Eq. (5), (27)
//   rates            J_b dw/dt = g o (M - r x T) - coupling of Eq. (6)                     Eq. (6), (28)
//   rotors           T, M of the speeds as measured, or of steady speeds behind lag and delay, Eq. (18)
//
// T and M are those of the base vehicle, which s and g correct: as a log has no force, it tells thrust over
// mass and moment over inertia alone. Rates are an output error: integrated over 50 ms from a start that is
// free. Over longer times, what pushes the vehicle would be taken for what its controller commands against
// it. The accelerometer's offset along z is told from the thrust by the poses.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/flight_parameter.hpp"
#include "swiftlet/identification/fitting/recent_results.hpp"
#include "swiftlet/identification/fitting/series_fit.hpp"
#include "swiftlet/identification/flight/flight_series.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// Where parameters stand in the vector; those that are absent stay at 0 (gains at 1).
struct FlightLayout {
  std::vector<FlightParameter> parameters;
  int lag = kAbsent;                          // tau_m
  int motor_delay = kAbsent;                  // from command to rotor speed, where that is measured
  int speed_scale = kAbsent;                  // measured over modelled steady speed, likewise
  int force_delay = kAbsent;                  // from command to specific force
  int rate_delay = kAbsent;                   // from command to angular acceleration
  int thrust = kAbsent;                       // s
  int gain[3] = {kAbsent, kAbsent, kAbsent};  // g about roll, pitch, yaw
  int trim[3] = {kAbsent, kAbsent,
                 kAbsent};  // r: centre of thrust along x, along y; torque over thrust about z, m
  int drag = kAbsent;       // c / m, 1/s
  std::vector<int> offset;  // b along x of each log; y and z follow
};

// One thread at a time: what was computed last is kept for the next call.
class FlightModel {
 public:
  // Of logs of one vehicle, all of one source of speeds. They must outlive the model.
  FlightModel(std::vector<FlightSeries> flights, plant::Vehicle base);

  const FlightLayout& layout() const { return layout_; }
  const std::vector<FlightSeries>& flights() const { return flights_; }
  const plant::Vehicle& base() const { return base_; }
  SpeedSource source() const { return flights_.front().source; }

  SeriesProblem problem(const std::function<void()>& on_iteration) const;

  // Value of a parameter, or what stands in for one that is absent.
  double value(const Eigen::VectorXd& parameters, int index, double absent = 0.0) const {
    return index == kAbsent ? absent : parameters[index];
  }
  // Moments of inertia about roll, pitch and yaw, kg m^2, if the mass is the base's; yaw with the base's
  // torque factor.
  Eigen::Vector3d inertia(const Eigen::VectorXd& parameters) const;

  // By these parameters, at rows of one of the flights: specific force without the offset, and moment over
  // inertia without coupling.
  struct Drive {
    std::vector<Eigen::Vector3d> specific_force;
    std::vector<Eigen::Vector3d> acceleration;  // rad/s^2
  };
  Drive drive(const Eigen::VectorXd& parameters, std::size_t flight, const Rows& rows) const;
  // The same by the speeds that the commands ask for, measured or not.
  Drive drive_by_commands(const Eigen::VectorXd& parameters, std::size_t flight, const Rows& rows) const;
  // dw/dt of these rates under that.
  static Eigen::Vector3d rate_derivative(const Eigen::Vector3d& inertia, const Eigen::Vector3d& acceleration,
                                         const Eigen::Vector3d& rates);
  Eigen::Vector3d offset(const Eigen::VectorXd& parameters, std::size_t flight) const;

 private:
  void assign_parameter_indices();
  // Thrust and moments by the base vehicle's numbers, at each of the rows.
  using Wrenches = std::vector<Eigen::Vector4d>;
  std::shared_ptr<const Wrenches> wrenches(const Eigen::VectorXd& parameters, std::size_t flight,
                                           const Rows& rows, double delay_s) const;
  Wrenches computed_wrenches(std::size_t flight, const Rows& rows, double lag_s, double delay_s) const;
  Wrenches wrenches_of(const std::vector<plant::PerRotor>& speeds) const;
  Drive drive_by(const Eigen::VectorXd& parameters, std::size_t flight, const Rows& rows,
                 const Wrenches& for_force, const Wrenches& for_rates) const;
  void residuals(const Eigen::VectorXd& parameters, Eigen::VectorXd& out) const;

  std::vector<FlightSeries> flights_;
  plant::Vehicle base_;
  plant::Effectiveness effectiveness_;
  FlightLayout layout_;
  std::vector<std::size_t> block_;  // rows of each flight that make one residual, their mean

  // By flight, first and last row, lag and delay: most parameters do not move the rotors.
  using WrenchKey = std::tuple<std::size_t, std::size_t, std::size_t, double, double>;
  mutable RecentResults<WrenchKey, Wrenches> wrenches_;
};

}  // namespace swiftlet::identification

// The model that is fitted to a flight's log, and its identifiable parameters.
//
//   specific force   f = (0, 0, -s T / m) - diag(c, c, c_z) / m V_b + b                    Eq. (5), (27)
//   rates            J_b dw/dt = g o (M - r x T) - coupling of Eq. (6)                     Eq. (6), (28)
//   rotors           T, M from the measured speeds, or from steady speeds with lag and delay, Eq. (18)
//
// T and M are the thrust and moments of the base vehicle; s and g scale them. The paper's c is isotropic. Along the
// rotors' axis c_z stands apart: the inflow of a climb changes the thrust, and the drag of the rotors acts in
// their plane only. A log holds no force, so that only thrust over mass and moment over inertia are
// identifiable. The residuals of the rates are an output error: the rates are integrated over 50 ms from a free
// initial value. Over longer times, the fit would attribute disturbances to the commands with which the
// controller rejects them. The poses separate the accelerometer's offset along z from the thrust.
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

// Indices of the parameters in the vector. Absent parameters have the index kAbsent and the value 0, gains 1.
struct FlightLayout {
  std::vector<FlightParameter> parameters;
  int lag = kAbsent;                          // tau_m
  int motor_delay = kAbsent;                  // from command to measured rotor speed
  int speed_scale = kAbsent;                  // measured over modelled rotor speed
  int force_delay = kAbsent;                  // from command to specific force
  int rate_delay = kAbsent;                   // from command to angular acceleration
  int thrust = kAbsent;                       // s
  int gain[3] = {kAbsent, kAbsent, kAbsent};  // g about roll, pitch, yaw
  int trim[3] = {kAbsent, kAbsent, kAbsent};  // r, m: centre of thrust y, x; torque over thrust about z
  int drag = kAbsent;                         // c / m, 1/s
  int axial_drag = kAbsent;                   // c_z / m, 1/s
  std::vector<int> offset;                    // b along x of each log; y and z follow
};

constexpr std::size_t kCachedPerFlight = 4;  // results of a model

// Not thread-safe: const methods cache the last results.
class FlightModel {
 public:
  // flights: logs of one vehicle with the same SpeedSource. The logs must outlive the model.
  FlightModel(std::vector<FlightSeries> flights, plant::Vehicle base);

  const FlightLayout& layout() const { return layout_; }
  const std::vector<FlightSeries>& flights() const { return flights_; }
  const plant::Vehicle& base() const { return base_; }
  SpeedSource source() const { return flights_.front().source; }

  SeriesProblem problem(const std::function<void()>& on_iteration) const;

  // Value of a parameter, or `absent` if the index is kAbsent.
  double value(const Eigen::VectorXd& parameters, int index, double absent = 0.0) const {
    return index == kAbsent ? absent : parameters[index];
  }
  // Moments of inertia about roll, pitch and yaw, kg m^2, for the base vehicle's mass and, about yaw, its
  // torque factor.
  Eigen::Vector3d inertia(const Eigen::VectorXd& parameters) const;

  // Model output at rows of a flight: specific force without the accelerometer's offset, and moment over
  // inertia without coupling.
  struct Drive {
    std::vector<Eigen::Vector3d> specific_force;  // m/s^2, FRD
    std::vector<Eigen::Vector3d> acceleration;    // rad/s^2, FRD
  };
  Drive drive(const Eigen::VectorXd& parameters, std::size_t flight, const Rows& rows) const;
  // The same with rotor speeds modelled from the commands, even if the log has measured ones.
  Drive drive_by_commands(const Eigen::VectorXd& parameters, std::size_t flight, const Rows& rows) const;
  // dw/dt, rad/s^2: acceleration less the coupling of Eq. (6) at these rates.
  static Eigen::Vector3d rate_derivative(const Eigen::Vector3d& inertia, const Eigen::Vector3d& acceleration,
                                         const Eigen::Vector3d& rates);
  Eigen::Vector3d offset(const Eigen::VectorXd& parameters, std::size_t flight) const;

 private:
  void assign_parameter_indices();
  // Thrust, N, and moments, N m, of the base vehicle at each row.
  using Wrenches = std::vector<Eigen::Vector4d>;
  std::shared_ptr<const Wrenches> wrenches(const Eigen::VectorXd& parameters, std::size_t flight,
                                           const Rows& rows, double delay_s) const;
  Wrenches computed_wrenches(std::size_t flight, const Rows& rows, double lag_s, double delay_s) const;
  Wrenches wrenches_of(const std::vector<plant::PerRotor>& speeds) const;
  Drive drive_by(const Eigen::VectorXd& parameters, std::size_t flight, const Rows& rows,
                 const Wrenches& for_force, const Wrenches& for_rates) const;
  // What the model says of the rows of a flight.
  struct Prediction {
    std::size_t first_row;
    Drive drive;
    Eigen::Vector3d inertia;
    Eigen::Vector3d bias;                 // of the accelerometer
    std::vector<plant::PerRotor> speeds;  // with measured rotor speeds only
  };
  struct Blocks {
    Eigen::Index begin = 0;   // first block of the segment
    Eigen::Index of_all = 0;  // number of blocks of all flights
  };
  double segment_residuals(const Eigen::VectorXd& parameters, std::size_t f, const Rows& segment,
                           const Prediction& by_model, Blocks blocks, Eigen::VectorXd& out) const;
  void vertical_residuals(const Eigen::VectorXd& parameters, std::size_t f, Eigen::Index& next,
                          Eigen::VectorXd& out) const;
  void residuals(const Eigen::VectorXd& parameters, Eigen::VectorXd& out) const;

  std::vector<FlightSeries> flights_;
  plant::Vehicle base_;
  plant::Effectiveness effectiveness_;
  FlightLayout layout_;
  std::vector<std::size_t> block_;  // rows of each flight that are averaged to one residual

  // Flight, first and last row, lag and delay. The other parameters do not change the wrenches.
  using WrenchKey = std::tuple<std::size_t, std::size_t, std::size_t, double, double>;
  mutable RecentResults<WrenchKey, Wrenches> wrenches_;
};

}  // namespace swiftlet::identification

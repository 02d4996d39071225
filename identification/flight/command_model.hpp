// The model that is fitted to a log of IMU and commands without poses or supply voltage.
//
//   rotors           s_i = sqrt(a(u_i) / N) with lag tau_m and a delay; s_i^2 is thrust over mass of rotor i
//   specific force   -f_z = sum s_i^2 + v_f
//   rates            dw/dt = g o (L s^2) + r sum s_i^2 + l (L_z ds/dt) - coupling of Eq. (6) + v_w
//
// a(u) is the thrust over mass of all N rotors, m/s^2, at a command u that is equal for all rotors: a
// polynomial of second order times a drift in time, as the supply voltage falls. The difference of a command
// from the mean of all rotors has a larger effect, by the ratio of supply_sag.hpp for the base vehicle. s_i
// is proportional to rotor speed, the state that has the lag. L holds the moments of the rotors relative to
// their mean lever d (signs, for equal levers), and g = m d / J: thrust factor times lever over inertia,
// divided by thrust factor over mass. r is the offset of the centre of thrust; l is the effect of the rotors'
// own inertia about yaw. The ratios of the moments of inertia are not identifiable: the coupling uses the
// base vehicle's.
//
// v is ARMA noise: gusts, thrust errors, gyro noise. The fit minimises its innovations. Samples are averaged
// over blocks of kSampleS.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/arma_noise.hpp"
#include "swiftlet/identification/fitting/flight_parameter.hpp"
#include "swiftlet/identification/fitting/recent_results.hpp"
#include "swiftlet/identification/fitting/series_fit.hpp"
#include "swiftlet/identification/flight/flight_series.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// A measured quantity that the model predicts.
enum class Response { kForce, kRoll, kPitch, kYaw };
constexpr std::size_t kResponses = 4;
constexpr std::array<Response, kResponses> kAllResponses = {Response::kForce, Response::kRoll,
                                                            Response::kPitch, Response::kYaw};
const char* response_name(Response response);  // "specific force", "roll"

constexpr double kSampleS = 0.005;  // s, approximate length of a block

// Thrust over mass of all rotors, m/s^2, as a function of a command that is equal for all rotors.
struct ThrustCurve {
  double middle = 0.5;     // command at which value and slope hold
  double value = 0.0;      // m/s^2
  double slope = 0.0;      // m/s^2 for full command
  double curvature = 0.0;  // m/s^2, half the second derivative

  double at(double command) const {
    const double off = command - middle;
    return value + off * (slope + off * curvature);
  }
  double slope_at(double command) const { return slope + 2.0 * (command - middle) * curvature; }
};

// The thrust over a log drifts as the supply voltage falls: it is that of the curve times 1 + per_s (t - middle_s).
struct ThrustDrift {
  double per_s = 0.0;
  double middle_s = 0.0;
};

// Thrust that is known from the specific force.
struct KnownThrust {
  ThrustCurve curve;
  std::vector<ThrustDrift> drift;  // of each log
};

// Indices of the parameters in the vector; kAbsent if not part of the fit.
struct CommandLayout {
  std::vector<FlightParameter> parameters;
  int lag = kAbsent;
  int force_delay = kAbsent;
  int rate_delay = kAbsent;
  int curve = kAbsent;     // value; slope and curvature follow
  std::vector<int> drift;  // of each log, 1/s
  int gain[3] = {kAbsent, kAbsent, kAbsent};
  int trim[3] = {kAbsent, kAbsent, kAbsent};
  int spin_up = kAbsent;
  int noise[kResponses] = {kAbsent, kAbsent, kAbsent, kAbsent};  // kNoiseParameters each, at the end
};

// Means over blocks of rows of a flight: estimation set, then validation set.
struct BlockedFlight {
  std::size_t rows_in_block = 1;
  std::size_t estimation_set = 0;                     // number of its blocks; the rest is the validation set
  std::vector<double> time_s;                         // middle of each block
  std::array<std::vector<double>, kResponses> means;  // thrust over mass, m/s^2; p, q, r, rad/s
  std::array<std::vector<double>, 3> coupling;        // rad/s, change by Eq. (6) since the last block

  std::size_t size() const { return time_s.size(); }
};

// Not thread-safe: const methods cache the last results.
class CommandModel {
 public:
  // Fits the given responses. `known` is required if they do not include kForce. The logs must outlive the
  // model.
  CommandModel(std::vector<FlightSeries> flights, plant::Vehicle base, std::vector<Response> responses,
               std::optional<KnownThrust> known);

  const CommandLayout& layout() const { return layout_; }
  std::vector<FlightParameter> physical_parameters() const;  // without those of the noise
  const std::vector<FlightSeries>& flights() const { return flights_; }
  const std::vector<BlockedFlight>& blocks() const { return blocks_; }
  const std::vector<Response>& responses() const { return responses_; }
  const plant::Vehicle& base() const { return base_; }
  double sample_s() const;  // s, length of a block

  SeriesProblem problem(const std::function<void()>& on_iteration) const;
  ThrustCurve curve(const Eigen::VectorXd& parameters) const;
  ThrustDrift drift(const Eigen::VectorXd& parameters, std::size_t flight) const;
  ArmaNoise noise(const Eigen::VectorXd& parameters, Response response) const;
  double lever(int axis) const { return lever_[static_cast<std::size_t>(axis)]; }  // d, m, of the base
  double shared_over_single() const { return shared_over_single_; }                // of the base vehicle

  // Model output of each block: thrust over mass, m/s^2, or change of a rate since the last block, rad/s.
  std::vector<double> modelled(const Eigen::VectorXd& parameters, std::size_t flight,
                               Response response) const;
  // Measured value less model output, in the same units: the noise v.
  std::vector<double> unexplained(const Eigen::VectorXd& parameters, std::size_t flight,
                                  Response response) const;

 private:
  bool has(Response response) const;
  void assign_parameter_indices();
  void add_noise(Response response);
  BlockedFlight blocked(const FlightSeries& series) const;

  using Speeds = std::vector<plant::PerRotor>;  // s_i of each row
  // Steady s_i at the commands of each row, from the start of the log to the end of the flight.
  std::shared_ptr<const Speeds> steady_speeds(const Eigen::VectorXd& parameters, std::size_t flight) const;
  Speeds speeds(const Eigen::VectorXd& parameters, std::size_t flight, double delay_s) const;

  // Sums over the rotors for each block.
  struct Thrust {
    std::vector<double> mean;  // of sum s^2, m/s^2
  };
  struct Moments {                            // changes since the last block
    std::vector<double> gained;               // m/s, of the integral of sum s^2
    std::array<std::vector<double>, 3> turn;  // m/s, of the integral of L s^2
    std::vector<double> spin_up;              // (m/s^2)^(1/2), of L_z s
  };
  std::shared_ptr<const Thrust> thrust(const Eigen::VectorXd& parameters, std::size_t flight) const;
  std::shared_ptr<const Moments> moments(const Eigen::VectorXd& parameters, std::size_t flight) const;
  Thrust thrust_of(std::size_t flight, const Speeds& speeds) const;
  Moments moments_of(std::size_t flight, const Speeds& speeds) const;
  void residuals(const Eigen::VectorXd& parameters, Eigen::VectorXd& out) const;

  std::vector<FlightSeries> flights_;
  plant::Vehicle base_;
  std::vector<Response> responses_;
  std::optional<KnownThrust> known_;
  double middle_command_ = 0.5;  // mean over the estimation set
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, plant::kMaxRotors> signs_;  // L
  std::array<double, 3> lever_{};
  double shared_over_single_ = 1.0;
  std::vector<BlockedFlight> blocks_;
  CommandLayout layout_;

  // Keys of the caches. Parameters outside a key do not change its result.
  using SteadyKey = std::array<double, 6>;  // flight, curve and drift
  using RotorsKey = std::array<double, 8>;  // lag and delay as well
  SteadyKey steady_key(const Eigen::VectorXd& parameters, std::size_t flight) const;
  RotorsKey rotors_key(const Eigen::VectorXd& parameters, std::size_t flight, double delay_s) const;
  mutable RecentResults<SteadyKey, Speeds> steady_speeds_;
  mutable RecentResults<RotorsKey, Thrust> thrust_;
  mutable RecentResults<RotorsKey, Moments> moments_;
};

// Start values for model `to`: the `values` of model `from` for parameters of the same name, `start` for the
// rest.
Eigen::VectorXd started_from(const CommandModel& from, const Eigen::VectorXd& values, const CommandModel& to,
                             Eigen::VectorXd start);

}  // namespace swiftlet::identification

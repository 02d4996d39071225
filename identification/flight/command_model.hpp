// The equations that a log of IMU and commands alone is fitted with.
//
//   rotors           s_i = sqrt(a(u_i) / N) behind the lag tau_m and a delay; its square is thrust over mass
//   specific force   -f_z = sum s_i^2 + v_f
//   rates            dw/dt = g o (L s^2) + r sum s_i^2 + l (L_z ds/dt) - coupling of Eq. (6) + v_w
//
// a(u) is the thrust over mass of all N rotors, m/s^2, at a command u that all have, a polynomial of second
// order times a drift in time, as the supply sinks; what a command differs by from the mean of all counts
// more, as supply_sag.hpp has it of the base. s_i goes with the speed of a rotor, which has the lag. L has
// the signs of the moments that the rotors make, over their lever d, and g = m d / J: the thrust factor
// times lever over inertia, over the thrust factor over mass. r is an offset of the thrust's centre, l what
// the rotors' own inertia does about yaw. The log tells no ratios of inertias: those of the base go into
// the coupling.
//
// v is coloured noise, and its innovations are what is made small: gusts, thrusts that are not quite the
// commanded ones, the gyro's noise. Samples are averaged over blocks of kSampleS.
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

// What was measured.
enum class Response { kForce, kRoll, kPitch, kYaw };
constexpr std::size_t kResponses = 4;
constexpr std::array<Response, kResponses> kAllResponses = {Response::kForce, Response::kRoll,
                                                            Response::kPitch, Response::kYaw};
const char* response_name(Response response);  // "specific force", "roll"

constexpr double kSampleS = 0.005;  // of blocks, about

// Thrust over mass of all rotors, m/s^2, over a command that they share.
struct ThrustCurve {
  double middle = 0.5;  // the command that the other numbers are of
  double value = 0.0;   // m/s^2
  double slope = 0.0;   // m/s^2 for full command
  double curvature = 0.0;

  double at(double command) const {
    const double off = command - middle;
    return value + off * (slope + off * curvature);
  }
  double slope_at(double command) const { return slope + 2.0 * (command - middle) * curvature; }
};

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
  int noise[kResponses] = {kAbsent, kAbsent, kAbsent, kAbsent};  // kNoiseParameters each, last of all
};

// Means over blocks of rows of a flight, fitted and kept.
struct BlockedFlight {
  std::size_t rows_in_block = 1;
  std::size_t estimation_set = 0;                     // blocks that are fitted; the rest is kept
  std::vector<double> time_s;                         // in the middle of each
  std::array<std::vector<double>, kResponses> means;  // thrust over mass, m/s^2; p, q, r, rad/s
  std::array<std::vector<double>, 3> coupling;        // what Eq. (6) adds to rates from a block to the next

  std::size_t size() const { return time_s.size(); }
};

// One thread at a time: what was computed last is kept for the next call.
class CommandModel {
 public:
  // Of some responses; without that of the force, the curve has to be given. The logs must outlive the model.
  CommandModel(std::vector<FlightSeries> flights, plant::Vehicle base, std::vector<Response> responses,
               std::optional<ThrustCurve> curve);

  const CommandLayout& layout() const { return layout_; }
  std::vector<FlightParameter> physical_parameters() const;  // all but those of the noise
  const std::vector<FlightSeries>& flights() const { return flights_; }
  const std::vector<BlockedFlight>& blocks() const { return blocks_; }
  const std::vector<Response>& responses() const { return responses_; }
  const plant::Vehicle& base() const { return base_; }
  double sample_s() const;  // length of a block

  SeriesProblem problem(const std::function<void()>& on_iteration) const;
  ThrustCurve curve(const Eigen::VectorXd& parameters) const;
  ArmaNoise noise(const Eigen::VectorXd& parameters, Response response) const;
  double lever(int axis) const { return lever_[static_cast<std::size_t>(axis)]; }  // d, by the base
  double shared_over_single() const { return shared_over_single_; }  // of the base, supply_sag.hpp

  // What the model has of each block: of the force its value, of a rate what it gains since the block before.
  std::vector<double> modelled(const Eigen::VectorXd& parameters, std::size_t flight,
                               Response response) const;
  // What was measured, in the same sense, less that: the noise.
  std::vector<double> unexplained(const Eigen::VectorXd& parameters, std::size_t flight,
                                  Response response) const;

 private:
  bool has(Response response) const;
  void assign_parameter_indices();
  void add_noise(Response response);
  BlockedFlight blocked(const FlightSeries& series) const;

  using Speeds = std::vector<plant::PerRotor>;  // s_i of each row
  // Where s_i tends to by the commands of each row up to the last of a flight's.
  std::shared_ptr<const Speeds> steady_speeds(const Eigen::VectorXd& parameters, std::size_t flight) const;
  Speeds speeds(const Eigen::VectorXd& parameters, std::size_t flight, double delay_s) const;

  // Sums over the rotors, of each block.
  struct Thrust {
    std::vector<double> mean;  // of sum s^2, m/s^2
  };
  struct Moments {                            // gains since the block before
    std::vector<double> gained;               // of the integral of sum s^2: m/s
    std::array<std::vector<double>, 3> turn;  // of that of L s^2
    std::vector<double> spin_up;              // of L_z s, (m/s^2)^(1/2)
  };
  std::shared_ptr<const Thrust> thrust(const Eigen::VectorXd& parameters, std::size_t flight) const;
  std::shared_ptr<const Moments> moments(const Eigen::VectorXd& parameters, std::size_t flight) const;
  Thrust thrust_of(std::size_t flight, const Speeds& speeds) const;
  Moments moments_of(std::size_t flight, const Speeds& speeds) const;
  void residuals(const Eigen::VectorXd& parameters, Eigen::VectorXd& out) const;

  std::vector<FlightSeries> flights_;
  plant::Vehicle base_;
  std::vector<Response> responses_;
  std::optional<ThrustCurve> given_curve_;
  double middle_command_ = 0.5;  // mean of the fitted rows
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, plant::kMaxRotors> signs_;  // L
  std::array<double, 3> lever_{};
  double shared_over_single_ = 1.0;
  std::vector<BlockedFlight> blocks_;
  CommandLayout layout_;

  // Most parameters move none of these, and lag and delays not what the speeds tend to.
  using SteadyKey = std::array<double, 5>;  // flight, curve and drift
  using RotorsKey = std::array<double, 7>;  // lag and delay as well
  SteadyKey steady_key(const Eigen::VectorXd& parameters, std::size_t flight) const;
  RotorsKey rotors_key(const Eigen::VectorXd& parameters, std::size_t flight, double delay_s) const;
  mutable RecentResults<SteadyKey, Speeds> steady_speeds_;
  mutable RecentResults<RotorsKey, Thrust> thrust_;
  mutable RecentResults<RotorsKey, Moments> moments_;
};

// Values of one model's parameters where another has them too, by their names; the rest as it is in `start`.
Eigen::VectorXd started_from(const CommandModel& from, const Eigen::VectorXd& values, const CommandModel& to,
                             Eigen::VectorXd start);

}  // namespace swiftlet::identification

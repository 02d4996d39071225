#include "swiftlet/identification/bench/bench.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "swiftlet/identification/fitting/inertia_triangle_inequality.hpp"
#include "swiftlet/identification/fitting/limits.hpp"
#include "swiftlet/plant/model/airframe.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::array<const char*, 3> kInertiaSymbols = {"J_x", "J_y", "J_z"};
constexpr double kSeaLevelDensity = 1.225;    // kg/m^3, standard atmosphere
constexpr double kCoaxial = 1e-3;             // m, hub distance in the rotor plane of coaxial rotors
constexpr double kNotableCorrelation = 0.05;  // smaller correlations are left out of the vehicle file

double& parameter_of(plant::Vehicle& vehicle, const std::string& key) {
  const std::map<std::string, double*> known = {{"mass", &vehicle.mass_kg},
                                                {"esc.gain", &vehicle.esc.gain},
                                                {"esc.offset", &vehicle.esc.offset_v2},
                                                {"motor.k2", &vehicle.motor.k2},
                                                {"motor.k3", &vehicle.motor.k3},
                                                {"motor.time_constant", &vehicle.motor.time_constant_s},
                                                {"rotor.thrust_factor", &vehicle.rotor.thrust},
                                                {"rotor.torque_factor", &vehicle.rotor.torque},
                                                {"inertia.xx", &vehicle.inertia(0, 0)},
                                                {"inertia.yy", &vehicle.inertia(1, 1)},
                                                {"inertia.zz", &vehicle.inertia(2, 2)}};
  return *known.at(key);
}

// The largest rotor radius, m: half the distance between the nearest hubs, as rotors do not overlap. Coaxial
// rotors may overlap.
double largest_radius(const plant::Vehicle& vehicle) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const plant::RotorMount& a : vehicle.rotors) {
    for (const plant::RotorMount& b : vehicle.rotors) {
      const double distance = (a.position_frd - b.position_frd).head<2>().norm();
      if (distance > kCoaxial) nearest = std::min(nearest, distance);
    }
  }
  return 0.5 * nearest;
}

double relative_error(const std::optional<Experiment>& experiment) {
  if (!experiment) return 0.0;
  const ParameterEstimate& estimate = experiment->estimates.front();
  return estimate.standard_error / estimate.value;
}

// Runs the experiments and collects their results.
class Bench {
 public:
  Bench(const BenchData& data, const plant::Vehicle& base, const BenchProgress& progress)
      : data_(data), progress_(progress) {
    out_.vehicle = base;
    all_ = count();
    if (all_ == 0) throw BenchError("", BadData("contains no experiment"));
  }

  BenchIdentification run() {
    if (data_.mass_kg) run(kMassName, [&] { adopt(out_.mass = identify_mass(*data_.mass_kg), "weighed"); });
    if (data_.esc) {
      run(kEscName, [&] { adopt(out_.esc = identify_esc(*data_.esc, data_.instruments), "Eq. (9)"); });
    }
    if (data_.thrust_torque) run(kThrustTorqueName, [&] { thrust_torque(); });
    if (data_.steady_motor) {
      run(kSteadyMotorName, [&] {
        adopt(out_.steady_motor = identify_steady_motor(*data_.steady_motor, data_.instruments), "Eq. (22)");
      });
    }
    if (data_.throttle_thrust) run(kThrottleThrustName, [&] { throttle_thrust(); });
    if (data_.motor_step) run(kMotorStepName, [&] { motor_step(); });
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (data_.inertia[axis]) run(kInertiaNames[axis], [&] { inertia(axis); });
    }
    limit_armature_resistance();
    enforce_inertia_triangle_inequality();
    correlate_inertia_with_mass();
    return std::move(out_);
  }

 private:
  std::size_t count() const {
    std::size_t all = 0;
    for (const bool there :
         {data_.mass_kg.has_value(), data_.esc.has_value(), data_.thrust_torque.has_value(),
          data_.steady_motor.has_value(), data_.motor_step.has_value(), data_.throttle_thrust.has_value(),
          data_.inertia[0].has_value(), data_.inertia[1].has_value(), data_.inertia[2].has_value()})
      all += there ? 1 : 0;
    return all;
  }

  template <typename Work>
  void run(const char* name, const Work& work) {
    name_ = name;
    if (progress_) progress_(name_, done_, all_);
    try {
      work();
    } catch (const BadData& fault) {
      throw BenchError(name_, fault);
    }
    ++done_;
  }

  // Copies the estimates into the vehicle, with their source, interval and correlations. Each estimate must
  // name a parameter of the vehicle file.
  void adopt(const std::optional<Experiment>& experiment, const std::string& how) {
    const std::vector<ParameterEstimate>& estimates = experiment->estimates;
    for (std::size_t i = 0; i < estimates.size(); ++i) {
      const ParameterEstimate& estimate = estimates[i];
      parameter_of(out_.vehicle, estimate.parameter) = estimate.value;
      out_.sources[estimate.parameter] =
          "bench " + name_ + ", " + std::to_string(experiment->measured.size()) + " readings, " + how;
      out_.uncertainty.parameters.push_back(
          {estimate.parameter, estimate.standard_error, estimate.low(), estimate.high()});
      for (std::size_t j = 0; j < i; ++j) {
        const auto a = static_cast<Eigen::Index>(i);
        const auto b = static_cast<Eigen::Index>(j);
        const double correlation = experiment->covariance(a, b) /
                                   std::sqrt(experiment->covariance(a, a) * experiment->covariance(b, b));
        if (std::abs(correlation) > kNotableCorrelation)
          out_.uncertainty.correlations.push_back(
              {estimates[j].parameter, estimate.parameter, std::clamp(correlation, -1.0, 1.0)});
      }
    }
  }

  void thrust_torque() {
    ThrustTorque found = identify_thrust_torque(*data_.thrust_torque, data_.instruments);
    out_.thrust = std::move(found.thrust);
    out_.torque = std::move(found.torque);
    std::optional<ParameterEstimate> thrust_factor;
    std::optional<ParameterEstimate> torque_factor;
    if (out_.thrust) {
      thrust_factor = out_.thrust->estimates.front();
      adopt(out_.thrust, "Eq. (25)");
    }
    if (out_.torque) {
      torque_factor = out_.torque->estimates.front();
      adopt(out_.torque, "Eq. (26)");
    }
    if (out_.thrust.has_value() != out_.torque.has_value()) require_torque_of_thrust();
    if (!data_.propeller) {
      require_possible_rotor(thrust_factor, torque_factor, {largest_radius(out_.vehicle), kSeaLevelDensity});
      return;
    }
    const std::vector<double>& speeds = data_.thrust_torque->speed_rad_s;
    std::vector<double> sorted = speeds;
    std::sort(sorted.begin(), sorted.end());
    const double top = sorted[(sorted.size() - 1) * 9 / 10];
    out_.propeller = propeller_coefficients(thrust_factor, torque_factor, *data_.propeller, top);
  }

  // Checks torque over thrust where only one factor was measured and the other is the base vehicle's.
  void require_torque_of_thrust() const {
    const double ratio_m = out_.vehicle.rotor.torque / out_.vehicle.rotor.thrust;
    if (ratio_m >= kLeastTorquePerThrust && ratio_m <= kMostTorquePerThrust) return;
    throw BadData(std::string(out_.thrust ? "thrust" : "torque") + ": torque over thrust is " +
                  format_number(ratio_m) + " m with the " + (out_.thrust ? "torque" : "thrust") +
                  " factor of the base vehicle, must be " + format_number(kLeastTorquePerThrust) + " to " +
                  format_number(kMostTorquePerThrust) +
                  " m; are the units right, and does the base vehicle match?");
  }

  void throttle_thrust() {
    const KnownParts known{out_.esc.has_value(), out_.steady_motor.has_value(), out_.thrust.has_value()};
    out_.throttle_thrust =
        identify_throttle_thrust(*data_.throttle_thrust, out_.vehicle, known, data_.instruments);
    if (!(known.esc && known.steady_motor && known.thrust)) {
      adopt(out_.throttle_thrust, "Eq. (9), (22) and (25) fitted together");
      return;
    }
    const ParameterEstimate& direct = out_.thrust->estimates.front();
    ParameterEstimate& chain = out_.throttle_thrust->estimates.front();
    chain.parameter = "throttle_thrust.thrust_factor";  // for comparison only
    const double difference = chain.value / direct.value - 1.0;
    const std::string numbers = "k_T is " + format_number(chain.value) +
                                " N*s^2 from throttle_thrust, through ESC and motor, and " +
                                format_number(direct.value) + " N*s^2 from thrust_torque: it differs by " +
                                format_number(100.0 * difference) + " %";
    const bool agree = std::abs(difference) < kAgreement;
    (agree ? out_.throttle_thrust->findings : out_.throttle_thrust->warnings)
        .push_back(numbers + (agree ? "; the chain of Eq. (9), (22) and (25) closes"
                                    : ", should be within 5 %: the experiments used different set-ups, or "
                                      "one of them is wrong"));
  }

  void motor_step() {
    out_.motor_step = identify_motor_step(*data_.motor_step, out_.vehicle, relative_error(out_.torque), [&] {
      if (progress_) progress_(name_, done_, all_);
    });
    const MotorStep& step = *out_.motor_step;
    if (step.decided)
      out_.vehicle.motor.model =
          step.physical_fits_better ? plant::MotorModel::kPhysical : plant::MotorModel::kReduced;
    const bool physical = out_.vehicle.motor.model == plant::MotorModel::kPhysical;
    const std::optional<Experiment> chosen = physical ? step.physical : step.reduced;
    adopt(chosen, physical ? "Eq. (15) fitted" : "Eq. (18) fitted");
  }

  void inertia(std::size_t axis) {
    InertiaTarget target;
    target.parameter = plant::kInertiaKeys[axis];
    target.symbol = kInertiaSymbols[axis];
    target.mass_kg = out_.vehicle.mass_kg;
    target.mass_error = relative_error(out_.mass);
    target.size_m = plant::hub_distance(out_.vehicle);
    const InertiaData& data = *data_.inertia[axis];
    out_.inertia[axis] =
        data.bifilar ? identify_inertia(*data.bifilar, target) : identify_inertia(*data.swing, target);
    adopt(out_.inertia[axis], data.bifilar ? "bifilar pendulum" : "physical pendulum");
  }

  // Moments of inertia are proportional to the mass and share its error.
  void correlate_inertia_with_mass() {
    if (!out_.mass) return;
    std::vector<std::pair<std::string, double>> with_mass;
    for (std::size_t axis = 0; axis < out_.inertia.size(); ++axis) {
      if (!out_.inertia[axis]) continue;
      const ParameterEstimate& inertia = out_.inertia[axis]->estimates.front();
      if (!(inertia.standard_error > 0.0)) continue;
      with_mass.emplace_back(plant::kInertiaKeys[axis],
                             relative_error(out_.mass) * inertia.value / inertia.standard_error);
    }
    const auto note = [this](const std::string& a, const std::string& b, double correlation) {
      if (std::abs(correlation) > kNotableCorrelation)
        out_.uncertainty.correlations.push_back({a, b, std::clamp(correlation, -1.0, 1.0)});
    };
    for (std::size_t i = 0; i < with_mass.size(); ++i) {
      note("mass", with_mass[i].first, with_mass[i].second);
      for (std::size_t k = 0; k < i; ++k)
        note(with_mass[k].first, with_mass[i].first, with_mass[k].second * with_mass[i].second);
    }
  }

  // Eq. (21): the friction F is negative for R_a above K2 K3 / k_Q. Lowers R_a to that limit: it is the base
  // vehicle's and was not measured.
  void limit_armature_resistance() {
    plant::Motor& motor = out_.vehicle.motor;
    const double most = motor.k2 * motor.k3 / out_.vehicle.rotor.torque;
    if (motor.armature_resistance_ohm <= most) return;
    out_.warnings.push_back("the armature resistance of the base vehicle, " +
                            format_number(motor.armature_resistance_ohm) +
                            " ohm, exceeds K2 K3 / k_Q = " + format_number(most) +
                            " ohm, above which the friction of Eq. (21) is negative: it is set to that");
    motor.armature_resistance_ohm = most;
    out_.sources["motor.armature_resistance"] = "estimate: K2 K3 / k_Q, Eq. (21) without friction";
  }

  void enforce_inertia_triangle_inequality() {
    std::array<std::optional<double>, 3> variances;
    for (std::size_t axis = 0; axis < variances.size(); ++axis) {
      if (out_.inertia[axis]) variances[axis] = out_.inertia[axis]->covariance(0, 0);
    }
    if (const auto warning = enforce_triangle_inequality(out_.vehicle.inertia, variances))
      out_.warnings.push_back(*warning);
  }

  static constexpr double kAgreement = 0.05;

  const BenchData& data_;
  const BenchProgress& progress_;
  BenchIdentification out_;
  std::string name_;
  std::size_t done_ = 0;
  std::size_t all_ = 0;
};

}  // namespace

BenchIdentification identify_bench(const BenchData& data, const plant::Vehicle& base,
                                   const BenchProgress& progress) {
  return Bench(data, base, progress).run();
}

}  // namespace swiftlet::identification

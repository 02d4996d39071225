// A flight integrated by Eq. (1) to (34), independent of plant/: identification recovers its parameters from
// the log.
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/identification/flight/command_model.hpp"
#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/flight_model.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::identification::flight_by_formulas_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;
using tests::kaylion;

constexpr double kG = 9.80665;
constexpr double kSample_s = 0.002;
constexpr int kSubsteps = 20;
constexpr double kOnGround_s = 0.5;
constexpr double kEnd_s = 60.0;

// Differs from the base, KayLion.
struct Truth {
  double mass = 0.040;
  Vector3d inertia{5.0e-5, 4.1e-5, 8.2e-5};
  double thrust = 3.98e-8, torque = 1.8623e-10;
  double tau = 0.070;
  double drag = 0.006;
  double lever = 0.0695 / std::sqrt(2.0);
  double k2 = 1.020e-3, k3 = 2.817e-7;

  double steady_speed(double supply_v, double throttle) const {
    const double v_a = std::sqrt(0.9205 * supply_v * supply_v * throttle + 0.6472);
    return (-k2 + std::sqrt(k2 * k2 + 4.0 * k3 * v_a)) / (2.0 * k3);
  }
  double hover_throttle(double supply_v) const {
    const double speed = std::sqrt(mass * kG / 4.0 / thrust);
    const double v_a = k2 * speed + k3 * speed * speed;
    return (v_a * v_a - 0.6472) / (0.9205 * supply_v * supply_v);
  }
};

struct State {
  Vector3d position{0.0, 0.0, -0.02};
  Vector3d velocity{0.0, 0.0, -0.5};
  Quaterniond q = Quaterniond::Identity();
  Vector3d rates = Vector3d::Zero();
  Vector4d speeds = Vector4d::Zero();
};

Vector3d specific_force(const Truth& t, const State& s) {
  const Vector3d lift(0.0, 0.0, -t.thrust * s.speeds.squaredNorm() / t.mass);
  return lift - t.drag / t.mass * (s.q.conjugate() * s.velocity);
}

struct Rates {
  Vector3d velocity, acceleration, turn, angular_acceleration;
  Vector4d speeds;
};
Rates rates_of(const Truth& t, const State& s, const Vector4d& steady) {
  const Vector4d f = t.thrust * s.speeds.cwiseAbs2();
  const Vector4d q = t.torque * s.speeds.cwiseAbs2();
  const Vector3d moment(t.lever * (-f[0] + f[1] + f[2] - f[3]), t.lever * (f[0] + f[1] - f[2] - f[3]),
                        q[0] - q[1] + q[2] - q[3]);  // Eq. (28)
  const Vector3d j = t.inertia;
  const Vector3d& w = s.rates;
  return {s.velocity, s.q * specific_force(t, s) + Vector3d(0.0, 0.0, kG), w,
          Vector3d((moment[0] + (j[1] - j[2]) * w[2] * w[1]) / j[0],  // Eq. (32) to (34)
                   (moment[1] + (j[2] - j[0]) * w[0] * w[2]) / j[1],
                   (moment[2] + (j[0] - j[1]) * w[0] * w[1]) / j[2]),
          (steady - s.speeds) / t.tau};
}
State integrated(const State& s, const Rates& r, double dt) {
  State out = s;
  out.position += dt * r.velocity;
  out.velocity += dt * r.acceleration;
  const Vector3d turn = dt * r.turn;
  if (turn.norm() > 0.0) out.q = s.q * Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  out.rates += dt * r.angular_acceleration;
  out.speeds += dt * r.speeds;
  return out;
}
// Midpoint rule: local error of third order in a step of 0.1 ms.
State midpoint_step(const Truth& t, const State& s, const Vector4d& steady, double dt) {
  return integrated(s, rates_of(t, integrated(s, rates_of(t, s, steady), 0.5 * dt), steady), dt);
}

// Excites every axis: a feedback loop on the true state plus a sum of cosines.
Vector4d throttles(const Truth& t, const State& s, double supply_v, double time) {
  const auto cosine = [&](double amplitude, double hertz) {
    return amplitude * std::cos(2.0 * M_PI * hertz * time);
  };
  const Vector3d angles = 2.0 * s.q.vec();
  const double roll_c = cosine(0.25, 0.21);
  const double pitch_c = cosine(0.3, 0.17);
  const double roll =
      0.02 * (roll_c - angles[0]) - 0.010 * s.rates[0] + cosine(0.008, 1.1) + cosine(0.02, 3.1);
  const double pitch =
      0.02 * (pitch_c - angles[1]) - 0.010 * s.rates[1] + cosine(0.008, 1.4) + cosine(0.02, 3.7);
  const double yaw = -0.1 * angles[2] - 0.1 * s.rates[2] + cosine(0.06, 0.9) + cosine(0.05, 2.3);
  const double climb = time < 3.0 ? -0.5 : 0.0;
  const double lift = 0.1 * (s.velocity.z() - climb) + cosine(0.03, 0.8) + cosine(0.04, 2.1);
  return Vector4d(-roll + pitch + yaw, roll + pitch - yaw, roll - pitch + yaw, -roll - pitch - yaw)
      .unaryExpr([&](double part) { return t.hover_throttle(supply_v) + lift + part; });
}

FlightLog flown(const Truth& truth, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double deviation) {
    return Vector3d(deviation * Vector3d(normal(generator), normal(generator), normal(generator)));
  };
  FlightLog log;
  log.name = "by formulas";
  log.rotor_count = 4;
  State state;
  for (int row = 0; row * kSample_s < kEnd_s; ++row) {
    const double time = row * kSample_s;
    const double supply_v = 4.1 - 0.01 * time;
    const bool flies = time >= kOnGround_s;
    if (!flies) state.speeds.setConstant(truth.steady_speed(supply_v, truth.hover_throttle(supply_v)));
    Vector4d throttle = Vector4d::Zero();
    if (flies) throttle = throttles(truth, state, supply_v, time);
    EXPECT_GE(throttle.minCoeff(), 0.0);
    EXPECT_LE(throttle.maxCoeff(), 1.0);
    log.time_s.push_back(time);
    log.specific_force_frd.push_back((flies ? specific_force(truth, state) : Vector3d(0.0, 0.0, -kG)) +
                                     noise(0.02));
    log.body_rates_frd.push_back(state.rates + noise(0.003));
    plant::PerRotor command{};
    plant::PerRotor speeds{};
    for (std::size_t i = 0; i < 4; ++i) {
      command[i] = throttle[static_cast<Eigen::Index>(i)];
      speeds[i] = state.speeds[static_cast<Eigen::Index>(i)] + normal(generator);
    }
    log.command.push_back(command);
    log.rotor_speeds.push_back(speeds);
    log.running.push_back(1);
    log.supply_voltage_v.push_back(supply_v);
    if (row % 5 == 0) {
      const Vector3d turn = noise(3e-4);
      const Vector3d position = flies ? state.position : Vector3d::Zero();
      const Quaterniond q = state.q * Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
      // q and -q are one attitude; motion capture may send either.
      log.poses.push_back({time, position + noise(5e-5), row % 10 == 0 ? q : Quaterniond(-q.coeffs())});
    }
    if (!flies) continue;
    Vector4d steady;
    for (Eigen::Index i = 0; i < 4; ++i) steady[i] = truth.steady_speed(supply_v, throttle[i]);
    for (int i = 0; i < kSubsteps; ++i) state = midpoint_step(truth, state, steady, kSample_s / kSubsteps);
    state.q.normalize();
  }
  return log;
}

const FlightLog& log_of_truth() {
  static const FlightLog log = flown(Truth(), 5);
  return log;
}

// The error is within twice the half width of the interval, which 1 error in 10,000 exceeds, and within a
// share that a missing factor would exceed by far.
void expect_found(const FlightIdentification& found, const std::string& name, double truth, double share) {
  const ParameterEstimate* const estimate = found.find(name);
  ASSERT_NE(estimate, nullptr) << name;
  EXPECT_LT(std::abs(estimate->value - truth), 2.0 * estimate->half_width)
      << name << " " << estimate->value << " for " << truth;
  EXPECT_LT(std::abs(estimate->value / truth - 1.0), share)
      << name << " " << estimate->value << " for " << truth;
}

TEST(FlightByFormulas, IdentifiesTheVehicleFromRotorSpeeds) {
  const Truth truth;
  const FlightIdentification found = identify_flight({log_of_truth()}, kaylion(), {});
  ASSERT_EQ(found.source, SpeedSource::kMeasured);
  EXPECT_TRUE(found.converged);
  expect_found(found, "motor.time_constant", truth.tau, 0.01);
  expect_found(found, "rotor.thrust_factor", truth.thrust, 0.01);
  expect_found(found, "inertia.xx", truth.inertia[0], 0.02);
  expect_found(found, "inertia.yy", truth.inertia[1], 0.02);
  expect_found(found, "inertia.zz", truth.inertia[2], 0.02);
  expect_found(found, "linear_drag", truth.drag, 0.1);
}

TEST(FlightByFormulas, IdentifiesTheVehicleWithoutRotorSpeeds) {
  const Truth truth;
  FlightLog log = log_of_truth();
  log.rotor_speeds.clear();
  const FlightIdentification found = identify_flight({log}, kaylion(), {});
  ASSERT_EQ(found.source, SpeedSource::kModelled);
  EXPECT_TRUE(found.converged);
  expect_found(found, "motor.time_constant", truth.tau, 0.03);
  expect_found(found, "rotor.thrust_factor", truth.thrust, 0.02);
  expect_found(found, "inertia.xx", truth.inertia[0], 0.04);
  expect_found(found, "inertia.yy", truth.inertia[1], 0.04);
  expect_found(found, "inertia.zz", truth.inertia[2], 0.04);
}

TEST(FlightByFormulas, IdentifiesLagAndGainsFromCommandsAlone) {
  const Truth truth;
  FlightLog log = log_of_truth();
  log.rotor_speeds.clear();
  log.supply_voltage_v.clear();
  log.poses.clear();
  plant::Vehicle base = kaylion();
  base.battery.internal_resistance_ohm = 0.0;  // the supply of this flight does not sag with rotor current
  const FlightIdentification found = identify_flight({log}, base, {});
  ASSERT_EQ(found.source, SpeedSource::kCommanded);
  EXPECT_TRUE(found.converged);
  expect_found(found, "motor.time_constant", truth.tau, 0.05);
  expect_found(found, "thrust_to_rate.roll", truth.mass * truth.lever / truth.inertia[0], 0.03);
  expect_found(found, "thrust_to_rate.pitch", truth.mass * truth.lever / truth.inertia[1], 0.03);
  expect_found(found, "thrust_to_rate.yaw", truth.mass * truth.torque / truth.thrust / truth.inertia[2],
               0.08);
}

// Eq. (6) with three different moments and rates, in the form of Eq. (32) to (34).
TEST(FlightModel, RateDerivativeFollowsEq32To34) {
  const Vector3d j(2.0, 3.0, 4.0);
  const Vector3d found = FlightModel::rate_derivative(j, {10.0, 20.0, 30.0}, {1.0, 2.0, 3.0});
  const Vector3d expected(10.0 + (3.0 - 4.0) * 3.0 * 2.0 / 2.0, 20.0 + (4.0 - 2.0) * 1.0 * 3.0 / 3.0,
                          30.0 + (2.0 - 3.0) * 1.0 * 2.0 / 4.0);
  EXPECT_LT((found - expected).norm(), 1e-12) << found.transpose();
}

// GIVEN the true parameters, the model predicts specific force and rates from the log's rotor speeds.
TEST(FlightModel, PredictsTheFlightFromRotorSpeeds) {
  const Truth truth;
  const std::vector<FlightLog> logs = {log_of_truth()};
  const plant::Vehicle& base = kaylion();
  const FlightModel model(prepare_flights(logs, base, {}), base);
  const FlightLayout& l = model.layout();
  Eigen::VectorXd x = model.problem({}).start;
  const double s = truth.thrust / base.rotor.thrust;
  x[l.thrust] = s * base.mass_kg / truth.mass;
  x[l.drag] = x[l.axial_drag] = truth.drag / truth.mass;
  for (int axis = 0; axis < 3; ++axis)
    x[l.gain[axis]] = (axis < 2 ? s : 1.0) * base.inertia(axis, axis) / truth.inertia[axis];
  const Rows rows = model.flights().front().estimation_set;
  const FlightModel::Drive drive = model.drive(x, 0, rows);
  ASSERT_EQ(drive.specific_force.size(), rows.size());
  double force = 0.0;
  Vector3d integrated_rates = Vector3d::Zero();
  Vector3d worst = Vector3d::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows.first + i;
    force += (logs[0].specific_force_frd[row] - drive.specific_force[i]).squaredNorm() /
             static_cast<double>(rows.size());
    if (i % 250 == 0) integrated_rates = logs[0].body_rates_frd[row];  // half a second at a time
    worst = worst.cwiseMax((logs[0].body_rates_frd[row] - integrated_rates).cwiseAbs());
    integrated_rates += kSample_s * FlightModel::rate_derivative(truth.inertia, drive.acceleration[i],
                                                                 logs[0].body_rates_frd[row]);
  }
  EXPECT_LT(std::sqrt(force), 0.02 * std::sqrt(3.0) * 1.2) << "the accelerometer's noise";
  // Gyro noise at both ends and the error of the rectangle rule: half a sample of the acceleration's change.
  EXPECT_LT(worst.maxCoeff(), 0.06) << worst.transpose();
}

TEST(ThrustCurve, SlopeMatchesItsFiniteDifference) {
  const ThrustCurve curve{0.4, 9.8, 30.0, -12.0};
  EXPECT_DOUBLE_EQ(curve.at(0.4), 9.8);
  EXPECT_DOUBLE_EQ(curve.at(0.6), 9.8 + 0.2 * 30.0 - 0.04 * 12.0);
  for (const double command : {0.1, 0.4, 0.9})
    EXPECT_NEAR(curve.slope_at(command), (curve.at(command + 1e-6) - curve.at(command - 1e-6)) / 2e-6, 1e-6);
}

}  // namespace swiftlet::identification::flight_by_formulas_test

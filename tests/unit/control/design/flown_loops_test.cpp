// The loops with delay and observers against closed forms, the margins of the design, and the control laws in
// the simulation.
#include "swiftlet/control/design/flown_loops.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::flown_loops_test {

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }
ControlSettings settings(const std::string& name) {
  return io::load_control_settings(tests::in_source("config/control/") + name + ".yaml");
}
std::array<FlownLoop, 6> loops(const std::string& name, double delay_s) {
  const ControlSettings of = settings(name);
  return flown_loops(design(kaylion(), of), of, delay_s);
}

// y'' + 2 zeta omega y' + omega^2 y = omega^2 r.
FlownLoop second_order(double omega, double zeta) {
  FlownLoop out;
  out.loop = {Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Unit(2, 1), Eigen::RowVectorXd::Zero(2)};
  out.loop.a(0, 1) = 1.0;
  out.loop.c << omega * omega, 2.0 * zeta * omega;
  out.reference = omega * omega * out.loop.b;
  out.output = Eigen::RowVectorXd::Unit(2, 0);
  return out;
}

TEST(StepResponse, OfASecondOrderLoopIsTheClosedForm) {
  constexpr double kOmega = 7.0;
  constexpr double kZeta = 0.4;
  constexpr double kStep_s = 0.01;
  const std::vector<double> response = step_response(second_order(kOmega, kZeta), kStep_s, 300);
  const double damped = kOmega * std::sqrt(1.0 - kZeta * kZeta);
  for (std::size_t i = 0; i < response.size(); ++i) {
    const double t = kStep_s * static_cast<double>(i);
    const double exact = 1.0 - std::exp(-kZeta * kOmega * t) *
                                   (std::cos(damped * t) + kZeta * kOmega / damped * std::sin(damped * t));
    ASSERT_NEAR(response[i], exact, 1e-9) << "at " << t << " s";
  }
  const double overshoot = std::exp(-M_PI * kZeta / std::sqrt(1.0 - kZeta * kZeta));
  EXPECT_NEAR(*std::max_element(response.begin(), response.end()), 1.0 + overshoot, 1e-3);
}

TEST(StepResponse, ReachesTheReferenceInEveryLoop) {
  for (const char* name : {"motor_lag", "paper"}) {
    const auto all = loops(name, 0.01);
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_NEAR(step_response(all[i], 0.1, 400).back(), 1.0, 1e-3) << name << " " << kFlownLoopNames[i];
  }
}

// Without delay the observers are exact, and the loops are those of the design.
TEST(FlownLoops, WithoutDelayHaveTheMarginsOfTheDesign) {
  for (const char* name : {"motor_lag", "paper"}) {
    const ControlDesign d = design(kaylion(), settings(name));
    const auto all = loops(name, 0.0);
    const double phase_deg[] = {d.roll.phase_margin_deg, d.pitch.phase_margin_deg, d.yaw.phase_margin_deg,
                                d.x.phase_margin_deg,    d.y.phase_margin_deg,     d.z.phase_margin_deg};
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_NEAR(phase_margin_deg(all[i].loop), phase_deg[i], 1e-6) << name << " " << kFlownLoopNames[i];
  }
}

// On double integrators the law has no observer: the delay takes omega T from the phase and nothing else.
TEST(FlownLoops, LoseThePhaseOfTheDelay) {
  constexpr double kDelay_s = 0.012;
  const auto without = loops("paper", 0.0);
  const auto with = loops("paper", kDelay_s);
  for (const std::size_t axis : {0, 1, 2}) {
    const double omega = crossovers(without[axis].loop).front();
    EXPECT_NEAR(crossovers(with[axis].loop).front(), omega, 1e-6);
    EXPECT_NEAR(phase_margin_deg(with[axis].loop),
                phase_margin_deg(without[axis].loop) - omega * kDelay_s * 180.0 / M_PI, 1e-3);
    EXPECT_NEAR(margins(with[axis].loop).delay_s, margins(without[axis].loop).delay_s - kDelay_s, 1e-4);
  }
}

// L = (k0 + k1 s) e^(-sT) / (s^2 (tau s + 1)) + k2 O(s), O being the rotor observer's answer to the command:
// (1/tau + beta e^(-sT) / (tau s + 1)) / (s + 1/tau + beta).
TEST(FlownLoops, OfTheAttitudeIncludeTheRotorObserver) {
  constexpr double kDelay_s = 0.010;
  const ControlSettings of = settings("motor_lag");
  const AttitudeAxisDesign roll = design(kaylion(), of).roll;
  const double lag = kaylion().motor.time_constant_s;
  const double beta = of.estimator.rotor_speed_bandwidth;
  const FlownLoop loop = loops("motor_lag", kDelay_s)[0];
  for (const double omega : {0.5, 5.0, 20.0, 60.0, 150.0}) {
    const std::complex<double> s(0.0, omega);
    const std::complex<double> response = std::exp(-s * kDelay_s) / (lag * s + 1.0);
    const std::complex<double> observed = (1.0 / lag + beta * response) / (s + 1.0 / lag + beta);
    const std::complex<double> exact =
        (roll.k[0] + roll.k[1] * s) * response / (s * s) + roll.k[2] * observed;
    EXPECT_LT(std::abs(frequency_response(loop.loop, omega) - exact), 2e-3 * std::abs(exact)) << omega;
  }
}

// The disturbance observer takes the delay of the thrust for a disturbance, so that it matters only with a
// delay.
TEST(FlownLoops, OfTheHeightIncludeTheDisturbanceObserver) {
  ControlSettings of = settings("motor_lag");
  const auto margin = [&](double bandwidth, double delay_s) {
    of.disturbance.bandwidth = bandwidth;
    return phase_margin_deg(flown_loops(design(kaylion(), of), of, delay_s)[5].loop);
  };
  EXPECT_NEAR(margin(20.0, 0.0), margin(0.0, 0.0), 1e-6);
  EXPECT_GT(std::abs(margin(20.0, 0.02) - margin(0.0, 0.02)), 0.1);
}

// Without a delay the observer is right, and the lead divides the lag of the thrust.
TEST(FlownLoops, OfTheHeightHaveTheLagThatTheThrustLeadLeaves) {
  ControlSettings of = settings("motor_lag");
  of.rough_air.thrust_lead = 1.5;
  const ControlDesign made = design(kaylion(), of);
  EXPECT_NEAR(phase_margin_deg(flown_loops(made, of, 0.0)[5].loop),
              phase_margin_deg(vertical_position_loop(made.z.gains, {kaylion().motor.time_constant_s / 2.5})),
              1e-6);
}

// Likewise the moment observer of the incremental law.
TEST(FlownLoops, OfTheAttitudeIncludeTheMomentObserverOfTheIncrementalLaw) {
  ControlSettings of = settings("motor_lag");
  const auto margin = [&](DisturbanceLaw law, double delay_s) {
    of.rough_air.law = law;
    return phase_margin_deg(flown_loops(design(kaylion(), of), of, delay_s)[0].loop);
  };
  EXPECT_NEAR(margin(DisturbanceLaw::kIncremental, 0.0), margin(DisturbanceLaw::kLead, 0.0), 1e-6);
  EXPECT_GT(std::abs(margin(DisturbanceLaw::kIncremental, 0.02) - margin(DisturbanceLaw::kLead, 0.02)), 0.1);
}

}  // namespace swiftlet::control::flown_loops_test

// The linear loops with observers and delay against the simulated flight: the motion after a push.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/design/flown_loops.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::flown_loops_flight_test {

using simulation::ClosedLoop;

constexpr double kPush_s = 0.05;
constexpr double kPushAt_s = 12.0;
constexpr double kForce_n = 0.16;
constexpr double kSeconds = 2.5;     // compared
constexpr double kSample_s = 0.002;  // of the IMU

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }
// Without the disturbance observer, which would compensate the push itself.
ControlSettings settings() {
  ControlSettings settings = io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"));
  settings.disturbance.bandwidth = 0.0;
  return settings;
}

// North position in simulated hover, at each IMU sample from the push on. The link delays commands by delay_s.
std::vector<double> flown(double delay_s) {
  plant::SimulationSettings simulation;
  plant::Fault push;
  push.kind = plant::FaultKind::kPush;
  push.at_s = kPushAt_s;
  push.for_s = kPush_s;
  push.force_ned = {kForce_n, 0.0, 0.0};
  simulation.faults = {push};
  if (delay_s > 0.0) {
    plant::Fault late;
    late.kind = plant::FaultKind::kCommandsDelay;
    late.at_s = kPushAt_s - 4.0;
    late.for_s = 10.0;
    late.delay_s = delay_s;
    simulation.faults.push_back(late);
  }
  ClosedLoop loop(kaylion(), simulation, settings(), 3);
  const auto ask = [&](RequestKind kind, double z_ned) {
    Request request;
    request.kind = kind;
    request.position_ned.z() = z_ned;
    EXPECT_TRUE(loop.controller.request(request).accepted);
  };
  loop.step_until([] { return false; }, 0.5);
  ask(RequestKind::kArm, 0.0);
  ask(RequestKind::kTakeoff, -1.0);
  loop.step_until([&] { return loop.time_s() > kPushAt_s - 0.5 * kSample_s; }, 20.0);
  std::vector<double> out;
  const double before = loop.plant.state().position_ned.x();
  for (double t = 0.0; t < kSeconds; t += kSample_s) {
    out.push_back(loop.plant.state().position_ned.x() - before);
    loop.step();
  }
  return out;
}

// The same by the linear loop, integrated by Runge-Kutta.
std::vector<double> modelled(double delay_s) {
  const ControlSettings of = settings();
  const FlownLoop x = flown_loops(design(kaylion(), of), of, delay_s)[3];
  const Eigen::MatrixXd a = x.loop.a - x.loop.b * x.loop.c;
  Eigen::VectorXd push = Eigen::VectorXd::Zero(a.rows());
  push[2] = kForce_n / kaylion().mass_kg;  // states: integral, position, velocity, ...
  constexpr int kSteps = 20;
  const double step_s = kSample_s / kSteps;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(a.rows());
  std::vector<double> out;
  for (double t = 0.0; t < kSeconds; t += kSample_s) {
    out.push_back(x.output.dot(state));
    const Eigen::VectorXd force = t < kPush_s - 0.5 * kSample_s ? push : Eigen::VectorXd(0.0 * push);
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::VectorXd k1 = a * state + force;
      const Eigen::VectorXd k2 = a * (state + 0.5 * step_s * k1) + force;
      const Eigen::VectorXd k3 = a * (state + 0.5 * step_s * k2) + force;
      const Eigen::VectorXd k4 = a * (state + step_s * k3) + force;
      state += step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
  return out;
}

double largest(const std::vector<double>& values) {
  double out = 0.0;
  for (const double value : values) out = std::max(out, std::abs(value));
  return out;
}
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

TEST(FlownLoops, PredictTheMotionAfterAPush) {
  const std::vector<double> motion = flown(0.0);
  ASSERT_GT(largest(motion), 0.02);
  EXPECT_LT(largest_difference(motion, modelled(0.5 * kSample_s)), 0.08 * largest(motion));
}

TEST(FlownLoops, PredictTheMotionWithLateCommands) {
  constexpr double kDelay_s = 0.03;
  const std::vector<double> motion = flown(kDelay_s);
  const double with_delay = largest_difference(motion, modelled(kDelay_s + 0.5 * kSample_s));
  EXPECT_LT(with_delay, 0.08 * largest(motion));
  EXPECT_LT(with_delay, 0.5 * largest_difference(motion, modelled(0.0))) << "the delay shows in the motion";
}

}  // namespace swiftlet::control::flown_loops_flight_test

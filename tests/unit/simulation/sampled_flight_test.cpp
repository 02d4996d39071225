// Trajectories that were sampled, rounded and written to a file fly like the trajectories themselves.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/control/planning/spline.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"
#include "tests/support/campaign.hpp"

namespace swiftlet::simulation::sampled_flight_test {

using control::PolynomialSegment;
using control::PositionYaw;
using Path = std::vector<PolynomialSegment>;

struct Lab {
  plant::Vehicle vehicle = io::load_vehicle(io::find_config("vehicles/kaylion.yaml"));
  plant::SimulationSettings world = io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  control::ControlSettings control = io::load_control_settings(io::find_config("control/motor_lag.yaml"));

  bool can_fly(const Path& path) const {
    const auto demands =
        control::worst_demands(vehicle, control.limits, control.failsafe.low_battery_voltage, path);
    return std::none_of(demands.begin(), demands.end(), [](const auto& demand) { return demand.exceeded(); });
  }
};
const Lab& lab() {
  static const Lab lab;
  return lab;
}

double uniform(std::mt19937_64& random, double from, double to) {
  return from + (to - from) * std::generate_canonical<double, 53>(random);
}

constexpr double kLowest_m = 0.25;  // a file of a lower path is raised

// Minimum snap through random points, at most as fast as the vehicle can fly.
Path random_path(std::mt19937_64& random) {
  std::vector<PositionYaw> points;
  const int count = 4 + static_cast<int>(uniform(random, 0.0, 5.0));
  for (int i = 0; i < count; ++i)
    points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1.8, -0.6),
                        uniform(random, -1, 1));
  const double leg_s = uniform(random, 0.8, 3.0);
  for (double stretch = 1.0;; stretch *= 1.1) {
    Path path = control::spline(control::Smoothness::kMinimumSnap, points,
                                std::vector<double>(points.size() - 1, stretch * leg_s));
    if (io::heights_of(path).least_m < kLowest_m) return random_path(random);
    if (lab().can_fly(path)) return path;
  }
}

double duration_s(const Path& path) {
  double sum = 0.0;
  for (const PolynomialSegment& segment : path) sum += segment.duration_s;
  return sum;
}
control::Reference at(const Path& path, double t_s) {
  std::size_t i = 0;
  while (i + 1 < path.size() && t_s > path[i].duration_s) t_s -= path[i++].duration_s;
  return control::evaluate(path[i], t_s);
}

// The file of another program: at the path's places at even times, with so many decimals.
std::string sampled(const Path& path, double rate_hz, int decimals, bool derivatives) {
  std::string text = derivatives ? "t,x,y,z,vx,vy,vz,ax,ay,az,yaw\n" : "t,x,y,z,yaw\n";
  const int count = static_cast<int>(std::ceil(duration_s(path) * rate_hz));
  for (int i = 0; i <= count; ++i) {
    const control::Reference r = at(path, i / rate_hz);
    const bool last = i == count;  // past the end of the path
    text += fmt::format("{:.6f}", i / rate_hz);
    const auto add = [&](const Eigen::Vector3d& v) {
      for (int axis = 0; axis < 3; ++axis) text += fmt::format(",{:.{}f}", v[axis], decimals);
    };
    add(r.position_ned);
    if (derivatives) add(last ? Eigen::Vector3d::Zero() : r.velocity_ned);
    if (derivatives) add(last ? Eigen::Vector3d::Zero() : r.acceleration_ned);
    text += fmt::format(",{:.{}f}\n", r.yaw_rad, decimals);
  }
  return text;
}

struct Error {
  double rms_m = 0.0;
  double peak_m = 0.0;
};

// The distance from the original path while `path` is flown, between a take-off and a landing.
Error fly(const Path& path, const Path& original, std::uint64_t seed) {
  using control::MissionItemKind;
  ClosedLoop loop(lab().vehicle, lab().vehicle, lab().world, lab().control, seed);
  control::Mission mission;
  mission.id = 1;
  mission.segments = path;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, path.front().z[0]}, 0, true, 0.5, 0.5},
                   {MissionItemKind::kTrajectory,
                    {0, 0, 0},
                    0,
                    false,
                    0.5,
                    0.5,
                    0,
                    static_cast<std::uint32_t>(path.size())},
                   {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.5, 0.0}};
  Error error;
  double sum = 0.0;
  int count = 0;
  const auto watch = [&] {
    const control::GuidanceState guidance = loop.controller.state().supervisor.guidance;
    if (guidance.mission.item_index != 1 || guidance.next_segment == 0 || !guidance.path.moving) return false;
    double t_s = 1e-9 * static_cast<double>(loop.plant.stamp_ns() - guidance.path.start_ns);
    for (std::size_t i = 0; i + 1 < guidance.next_segment; ++i) t_s += path[i].duration_s;
    const double here_m = (loop.plant.truth().position_ned - at(original, t_s).position_ned).norm();
    sum += here_m * here_m;
    error.peak_m = std::max(error.peak_m, here_m);
    ++count;
    return false;
  };
  const SimulatedFlight flight = simulation::fly(
      loop, mission, io::planned_duration_s(mission, lab().control.limits), {nullptr, nullptr, watch});
  EXPECT_TRUE(flight.completed) << flight.reason;
  error.rms_m = std::sqrt(sum / count);
  return error;
}

TEST(SampledFlight, AddsAtMostAMillimetreToTheError) {
  const int cases = tests::is_soak() ? 400 : 16;
  std::mt19937_64 random(21);
  for (int i = 0; i < cases; ++i) {
    const Path path = random_path(random);
    const double rate_hz = std::round(std::exp(uniform(random, std::log(20.0), std::log(1000.0))));
    const int decimals = 3 + static_cast<int>(uniform(random, 0.0, 7.0));
    const bool derivatives = uniform(random, 0.0, 1.0) < 0.5;
    SCOPED_TRACE(fmt::format("case {}: {} Hz, {} decimals{}, {:.1f} s", i, rate_hz, decimals,
                             derivatives ? ", with derivatives" : "", duration_s(path)));
    Path read;
    ASSERT_NO_THROW(read = io::parse_any_mission_file(sampled(path, rate_hz, decimals, derivatives), "s.csv",
                                                      lab().control.limits, {io::MissionFrame::kNed, {}})
                               .mission.segments);
    EXPECT_TRUE(lab().can_fly(read));
    const Error original = fly(path, path, 1);
    const Error again = fly(read, path, 1);
    EXPECT_LT(again.rms_m, original.rms_m + 1e-3);
    const double rounding_m = std::sqrt(3.0) * 0.5 * std::pow(10.0, -decimals);  // of a place
    EXPECT_LT(again.peak_m, original.peak_m + 1e-3 + rounding_m);
    EXPECT_LT(original.rms_m, 0.02);
  }
}

}  // namespace swiftlet::simulation::sampled_flight_test

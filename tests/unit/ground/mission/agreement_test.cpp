// The dry run, the control service's check of an upload and the flight agree: on whether a mission can be flown, and on
// how long each of its items takes.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/mission_runner.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::ground::agreement_test {

using control::MissionItem;
using control::MissionItemKind;
using Eigen::Vector3d;

const std::string kConfig = tests::in_source("config/");
constexpr double kSameTime_s =
    0.05;  // the watch looks at the telemetry rate, and a take-off begins where it is estimated
// From the first contact until the reference has been 5 cm below the ground for 0.2 s. The touchdown ends the flight at once where it
// gives an accelerometer sample above failsafe.impact_m_s2.
constexpr double kTouchdown_s = 0.55;

class RandomMissions {
 public:
  explicit RandomMissions(std::uint64_t seed) : random_(seed) {}

  io::MissionFile next() {
    io::MissionFile file;
    file.name = "random";
    file.mission.id = 1;
    MissionItem takeoff;
    takeoff.kind = MissionItemKind::kTakeoff;
    takeoff.position_ned.z() = -uniform(0.6, 1.6);
    takeoff.speed = uniform(0.3, 1.0);
    takeoff.hold_s = uniform(0.0, 1.0);
    file.mission.items.push_back(takeoff);
    const int count = 1 + static_cast<int>(uniform(0.0, 4.0));
    for (int i = 0; i < count; ++i) file.mission.items.push_back(item(file.mission));
    MissionItem land;
    land.kind = MissionItemKind::kLand;
    land.speed = uniform(0.2, 0.8);
    file.mission.items.push_back(land);
    return file;
  }

 private:
  double uniform(double from, double to) {
    return from + (to - from) * std::generate_canonical<double, 53>(random_);
  }
  Vector3d place() { return {uniform(-1.2, 1.2), uniform(-1.2, 1.2), uniform(-1.8, -0.5)}; }

  MissionItem item(control::Mission& mission) {
    const double kind = uniform(0.0, 1.0);
    MissionItem item;
    item.speed = uniform(0.2, 2.0);
    item.hold_s = uniform(0.0, 1.0);
    if (kind < 0.2) {
      item.kind = MissionItemKind::kWait;
      item.hold_s = uniform(0.2, 2.0);
    } else if (kind < 0.6) {
      item.position_ned = place();
      item.yaw_free = uniform(0.0, 1.0) < 0.5;
      item.yaw_rad = uniform(-3.1, 3.1);
    } else {
      item.kind = MissionItemKind::kTrajectory;
      item.yaw_free = false;
      item.first_segment = static_cast<std::uint32_t>(mission.segments.size());
      item.segment_count = 2;
      Vector3d at = place();
      for (std::uint32_t i = 0; i < item.segment_count; ++i) {
        const Vector3d to = place();
        // From calm to beyond the rotors and the limits of the control settings.
        const double duration_s = (to - at).norm() * std::exp(uniform(std::log(0.6), std::log(4.0))) + 0.2;
        mission.segments.push_back(control::minimum_jerk(at, 0.0, to, 0.0, duration_s));
        at = to;
      }
    }
    return item;
  }

  std::mt19937_64 random_;
};

class AgreementTest : public testing::Test {
 protected:
  // When each item began, and when the rotors stopped, s since the start of the mission.
  struct Flown {
    std::string reason;
    std::vector<double> item_starts_s;
    double duration_s = 0.0;
  };
  Flown fly(const control::Mission& mission, double planned_duration_s, std::uint64_t seed) const {
    simulation::ClosedLoop loop(vehicle_, vehicle_, world_, settings_, seed);
    Flown out;
    double start_s = 0.0;
    const auto watch = [&] {
      const auto& progress = loop.controller.state().supervisor.guidance.mission;
      if (progress.state != control::MissionState::kRunning) return false;
      const double now_s = 1e-9 * static_cast<double>(loop.plant.stamp_ns());
      if (out.item_starts_s.empty()) start_s = now_s;
      while (out.item_starts_s.size() <= static_cast<std::size_t>(progress.item_index))
        out.item_starts_s.push_back(now_s - start_s);
      out.duration_s = now_s - start_s;
      return false;
    };
    const simulation::SimulatedFlight flight =
        simulation::fly(loop, mission, planned_duration_s, {nullptr, nullptr, watch});
    out.reason = flight.reason;
    return out;
  }

  plant::Vehicle vehicle_ = io::load_vehicle(kConfig + "vehicles/kaylion.yaml");
  control::ControlSettings settings_ = io::load_control_settings(kConfig + "control/motor_lag.yaml");
  plant::SimulationSettings world_ = io::load_simulation_settings(kConfig + "simulation/default.yaml");
};

TEST_F(AgreementTest, OfDryRunUploadAndFlight) {
  const int cases = tests::draws(200, 2000);
  const int flights = tests::draws(25, 1000);
  RandomMissions missions(7);
  int flown = 0;
  int beyond_rotors = 0;
  int beyond_limits = 0;
  const double impact_acceleration = settings_.failsafe.impact_acceleration;
  constexpr double kNoImpact = 1e9;  // m/s^2
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE(fmt::format("case {}", i));
    const io::MissionFile file = missions.next();
    const MissionCheck check = check_mission(file, vehicle_, settings_);
    // What the control service knows when the mission is uploaded.
    const control::Outcome limits = control::check(file.mission, settings_.limits);
    const control::Outcome rotors =
        limits.accepted ? control::check_rotors("the mission", vehicle_, settings_.limits,
                                                settings_.failsafe.low_battery_voltage, file.mission.segments)
                        : limits;
    beyond_limits += limits.accepted ? 0 : 1;
    beyond_rotors += limits.accepted && !rotors.accepted ? 1 : 0;
    if (!rotors.accepted) {
      EXPECT_FALSE(check.feasible()) << rotors.reason;
    }
    if (!check.feasible() || flown == flights) continue;
    ++flown;
    const bool ends_by_impact = flown % 2 == 0;
    settings_.failsafe.impact_acceleration = ends_by_impact ? impact_acceleration : kNoImpact;
    const Flown flight = fly(file.mission, check.duration_s, static_cast<std::uint64_t>(i) + 1);
    EXPECT_EQ(flight.reason, "");
    ASSERT_EQ(flight.item_starts_s.size(), check.items.size());
    for (std::size_t k = 0; k < check.items.size(); ++k)
      EXPECT_NEAR(flight.item_starts_s[k], check.items[k].start_s, kSameTime_s) << "item " << k + 1;
    EXPECT_LE(flight.duration_s, check.duration_s + kSameTime_s);
    EXPECT_GE(flight.duration_s, check.duration_s - (ends_by_impact ? kTouchdown_s : kSameTime_s));
  }
  // Each of the three happens.
  EXPECT_GT(flown, flights / 2);
  EXPECT_GT(beyond_rotors, 0);
  EXPECT_GT(beyond_limits, 0);
}

}  // namespace swiftlet::ground::agreement_test

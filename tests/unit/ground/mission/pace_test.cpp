// --as-fast-as-possible: the least time scale at which the vehicle can fly a mission.
#include "swiftlet/ground/mission/pace.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::ground::pace_test {

using control::Demand;

const std::string kConfig = tests::in_source("config/");
const std::string kFigureOfEight = io::kData + "crazyswarm_figure8.csv";

class PaceTest : public testing::Test {
 protected:
  PaceTest() {
    // Beyond what the rotors can do: they are what is met.
    agile_.limits.max_speed = 20.0;
    agile_.limits.max_acceleration = 50.0;
    agile_.limits.max_tilt_rad = 1.2;
    fastest_.as_fast_as_possible = true;
  }
  bool can_fly(const io::MissionFile& file, const control::ControlSettings& settings, double reserve) const {
    return control::check(file.mission, settings.limits).accepted &&
           check_mission(file, vehicle_, settings, {Eigen::Vector2d::Zero(), {}, reserve}).feasible();
  }

  plant::Vehicle vehicle_ = io::load_vehicle(kConfig + "vehicles/kaylion.yaml");
  control::ControlSettings settings_ = io::load_control_settings(kConfig + "control/motor_lag.yaml");
  control::ControlSettings agile_ = settings_;
  ReadingOptions fastest_;
  tests::TemporaryFolder folder_;
};

TEST_F(PaceTest, IsTheLeastTimeScaleThatCanBeFlown) {
  for (const std::string& path :
       {kFigureOfEight, kConfig + "missions/square.yaml", kConfig + "missions/tour.yaml"}) {
    for (const control::ControlSettings* const settings : {&settings_, &agile_}) {
      const io::MissionFile file = io::load_mission_file(path, settings->limits);
      const Pace pace = fastest_pace(file, vehicle_, *settings, {Eigen::Vector2d::Zero(), {}, 0.1});
      EXPECT_TRUE(can_fly(io::stretched(file, pace.time_scale), *settings, 0.1)) << path;
      EXPECT_FALSE(can_fly(io::stretched(file, pace.time_scale / 1.02), *settings, 0.1)) << path;
      EXPECT_FALSE(pace.limit.empty());
    }
  }
}

TEST_F(PaceTest, MeetsTheLimitOfTheRotorsWithTheReserve) {
  double before = 0.0;
  for (const double reserve : {0.0, 0.1, 0.3}) {
    const CheckConditions conditions{Eigen::Vector2d::Zero(), {}, reserve};
    const io::MissionFile file = io::load_mission_file(kFigureOfEight, agile_.limits);
    const Pace pace = fastest_pace(file, vehicle_, agile_, conditions);
    EXPECT_GT(pace.time_scale, before) << "a greater reserve is slower";
    before = pace.time_scale;
    const bool of_rotors = pace.limit.find("thrust of a rotor is") != std::string::npos;
    EXPECT_TRUE(of_rotors) << pace.limit;
    EXPECT_NE(pace.limit.find("item 2 (trajectory): "), std::string::npos) << pace.limit;
    // At the limit itself: without a reserve the same flight uses all but the reserve.
    const MissionCheck check = check_mission(io::stretched(file, pace.time_scale), vehicle_, agile_);
    double least_spare = 1.0;
    for (const ItemCheck& item : check.items) {
      if (item.demands.empty()) continue;
      const control::WorstDemand& low = item.demands[static_cast<std::size_t>(Demand::kRotorLeast)];
      const control::WorstDemand& high = item.demands[static_cast<std::size_t>(Demand::kRotorMost)];
      const double range = high.limit - low.limit;
      least_spare =
          std::min({least_spare, (low.value - low.limit) / range, (high.limit - high.value) / range});
    }
    EXPECT_NEAR(least_spare, reserve, 0.01);
  }
}

// GIVEN a path that is too fast for the control settings THEN it is slowed, and the file is read as with --time-scale.
TEST_F(PaceTest, SlowsAPathThatIsTooFast) {
  const std::string path =
      folder_.write("p.csv", io::kPolynomialHeader + "\n" + io::polynomial_row(1.0, 0.0, 2.0, 1.0) + "\n");
  EXPECT_THROW(load_mission(path, {}, vehicle_, settings_), io::ConfigError);
  const io::MissionFile file = load_mission(path, fastest_, vehicle_, settings_);
  EXPECT_TRUE(can_fly(file, settings_, fastest_.reserve));
  EXPECT_TRUE(assumes(file, "as fast as possible with a reserve of 10 %: --time-scale "));
  // 15/8 of 2 m in the time of the path are its greatest speed, 10/sqrt(3) of 2 m in its square the acceleration.
  const double duration_s = file.mission.segments.front().duration_s;
  const double needed_s =
      std::max(15.0 / 8.0 * 2.0 / settings_.limits.max_speed,
               std::sqrt(10.0 / std::sqrt(3.0) * 2.0 / settings_.limits.max_acceleration));
  EXPECT_NEAR(duration_s, needed_s, 0.01 * needed_s);
  EXPECT_TRUE(assumes(file, "the limit is 2.000 m/s: at ")) << file.assumptions.back();

  const io::TrajectoryFile trajectory = load_trajectory(path, fastest_, vehicle_, settings_);
  EXPECT_NEAR(trajectory.segments.front().duration_s, duration_s, 0.01 * duration_s);
}

TEST_F(PaceTest, SaysWhyAMissionCannotBeFlownAtAnyPace) {
  vehicle_.mass_kg *= 2.5;
  try {
    load_mission(kConfig + "missions/square.yaml", fastest_, vehicle_, settings_);
    FAIL() << "it was read";
  } catch (const io::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be flown, also 17.0859 times as slow: item "),
              std::string::npos)
        << error.what();
  }
}

}  // namespace swiftlet::ground::pace_test

// Environments of reinforcement learning: what they start with, reward and end, and that they repeat.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/simulation/dispersion_file.hpp"
#include "swiftlet/simulation/vector_environment.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/simulation/nominal_world.hpp"

namespace swiftlet::simulation::environment_test {

using plant::ControlLevel;

constexpr std::size_t kObservation = 22;
constexpr std::size_t kTrajectoryActions = 4;

std::vector<double> observed(const HoverEnvironment& environment) {
  std::vector<double> observation(kObservation);
  environment.observe(observation.data());
  return observation;
}

HoverTask task_at(ControlLevel level) {
  HoverTask task;
  task.level = level;
  return task;
}

// A pilot that flies to the target with velocities.
std::vector<double> towards_target(const std::vector<double>& observation) {
  return {2.0 * observation[0], 2.0 * observation[1], 2.0 * observation[2], 0.0};
}

TEST(HoverEnvironment, StartsNearTheTargetAsTheTaskSays) {
  HoverTask task;
  HoverEnvironment environment(nominal(), task, {});
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    environment.reset(seed);
    const std::vector<double> seen = observed(environment);
    EXPECT_LE(Eigen::Vector3d(seen[0], seen[1], seen[2]).norm(), task.start_distance_m);
    EXPECT_LE(Eigen::Vector3d(seen[3], seen[4], seen[5]).norm(), task.start_speed_m_s);
    EXPECT_GE(seen[14], std::cos(task.start_tilt_rad));
    EXPECT_LE(Eigen::Vector3d(seen[15], seen[16], seen[17]).norm(), task.start_rate_rad_s);
    EXPECT_NEAR(seen[18], 1.0, 1e-12);
  }
}

TEST(HoverEnvironment, ObservesPositionAndAttitudeOfTheGroundTruth) {
  HoverTask task;
  HoverEnvironment environment(nominal(), task, {});
  environment.reset(3);
  const plant::VehicleState& state = environment.plant().state();
  const std::vector<double> seen = observed(environment);
  const Eigen::Matrix3d rotation = state.q_ned_from_frd.toRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(seen[static_cast<std::size_t>(i)], task.target_ned[i] - state.position_ned[i]);
    for (int j = 0; j < 3; ++j) EXPECT_EQ(seen[static_cast<std::size_t>(6 + 3 * i + j)], rotation(i, j));
  }
}

TEST(HoverEnvironment, RewardsEachStepByDistanceAndBodyRate) {
  const HoverTask task = task_at(ControlLevel::kTrajectory);
  HoverEnvironment environment(nominal(), task, {});
  environment.reset(5);
  const std::vector<double> action = towards_target(observed(environment));
  const auto outcome = environment.step(action.data());
  const std::vector<double> seen = observed(environment);
  const double distance = Eigen::Vector3d(seen[0], seen[1], seen[2]).norm();
  const double rate = Eigen::Vector3d(seen[15], seen[16], seen[17]).norm();
  EXPECT_DOUBLE_EQ(outcome.reward, 0.02 * (1.0 - distance / task.radius_m - 0.02 * rate));
}

TEST(HoverEnvironment, HoversWithTheFirmwareUntilTheTimeIsOver) {
  const HoverTask task = task_at(ControlLevel::kTrajectory);
  HoverEnvironment environment(nominal(), task, {});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    environment.reset(seed);
    double sum = 0.0;
    int steps = 0;
    HoverEnvironment::Outcome outcome;
    while (!outcome.terminated && !outcome.truncated) {
      const std::vector<double> action = towards_target(observed(environment));
      outcome = environment.step(action.data());
      sum += outcome.reward;
      ++steps;
    }
    EXPECT_TRUE(outcome.truncated) << "seed " << seed;
    EXPECT_EQ(steps, 500);
    EXPECT_GT(sum, 8.0) << "of at most 10 s";
    EXPECT_LT(Eigen::Vector3d::Map(observed(environment).data()).norm(), 0.05);
  }
}

TEST(HoverEnvironment, EndsWhereTheVehicleFallsOutOfTheRadius) {
  HoverEnvironment environment(nominal(), task_at(ControlLevel::kActuators), {});
  environment.reset(1);
  const std::vector<double> no_throttle(4, 0.0);
  int steps = 0;
  HoverEnvironment::Outcome outcome;
  while (!outcome.terminated) {
    outcome = environment.step(no_throttle.data());
    ASSERT_FALSE(outcome.truncated);
    ++steps;
  }
  EXPECT_EQ(outcome.reward, 0.0);
  EXPECT_LT(steps, 50) << "a metre of fall takes half a second";
}

TEST(HoverEnvironment, HoldsItsHeightWithTheRatesAndThrustOfHover) {
  HoverTask task = task_at(ControlLevel::kRates);
  task.start_distance_m = task.start_speed_m_s = task.start_tilt_rad = task.start_rate_rad_s = 0.0;
  HoverEnvironment environment(nominal(), task, {});
  environment.reset(1);
  const double hover[] = {0.0, 0.0, 0.0, plant::kGravity};
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(environment.step(hover).terminated);
  EXPECT_LT(std::abs(observed(environment)[2]), 0.1) << "height after one second";
}

TEST(HoverEnvironment, ClipsAnActionBeyondItsBounds) {
  HoverEnvironment clipped(nominal(), task_at(ControlLevel::kActuators), {});
  HoverEnvironment at_bound(nominal(), task_at(ControlLevel::kActuators), {});
  clipped.reset(1);
  at_bound.reset(1);
  const double beyond[] = {7.0, 7.0, 7.0, 7.0};
  const double bound[] = {1.0, 1.0, 1.0, 1.0};
  clipped.step(beyond);
  at_bound.step(bound);
  EXPECT_EQ(observed(clipped), observed(at_bound));
}

TEST(HoverEnvironment, BoundsTheThrustByWhatTheRotorsGive) {
  const ActionBounds bounds = action_bounds(task_at(ControlLevel::kRates), nominal().vehicle);
  const plant::Vehicle& vehicle = nominal().vehicle;
  const double full_v = plant::open_circuit_voltage(vehicle.battery, 1.0);
  EXPECT_DOUBLE_EQ(bounds.high[3] * vehicle.mass_kg,
                   4.0 * plant::steady_thrust_from_throttle(vehicle, full_v, 1.0));
  EXPECT_GT(bounds.high[3], plant::kGravity);
}

TEST(HoverEnvironment, RefusesATaskThatBreaksARule) {
  HoverTask uneven;
  uneven.action_period_s = 0.0205;
  HoverTask too_long;
  too_long.action_period_s = 0.3;  // the vehicle would level itself in between
  HoverTask in_the_ground;
  in_the_ground.target_ned.z() = -0.3;
  HoverTask outside;
  outside.start_distance_m = 2.0;
  for (const HoverTask& task : {uneven, too_long, in_the_ground, outside})
    EXPECT_THROW(HoverEnvironment(nominal(), task, {}), std::invalid_argument);
}

TEST(HoverEnvironment, RefusesAVehicleThatBreaksARule) {
  World broken = nominal();
  broken.vehicle.battery.open_circuit_voltage_v.clear();
  EXPECT_THROW(VectorEnvironment(broken, {}, {}, 1, 1), std::invalid_argument);
}

TEST(HoverEnvironment, DrawsAnotherVehicleForEachEpisode) {
  const Dispersion dispersion =
      load_dispersion_file(tests::in_source("config/dispersion/kaylion.yaml"), nominal());
  HoverTask task = task_at(ControlLevel::kRates);
  task.start_distance_m = task.start_speed_m_s = task.start_tilt_rad = task.start_rate_rad_s = 0.0;
  HoverEnvironment drawn(nominal(), task, dispersion);
  const double hover[] = {0.0, 0.0, 0.0, plant::kGravity};
  drawn.reset(1);
  for (int i = 0; i < 5; ++i) drawn.step(hover);
  const double first = observed(drawn)[5];
  drawn.reset();
  for (int i = 0; i < 5; ++i) drawn.step(hover);
  EXPECT_GT(std::abs(observed(drawn)[5] - first), 1e-3) << "another mass gives another vertical speed";
}

// What many environments give in some steps: everything that step() writes.
std::vector<double> flown(std::size_t threads, std::uint64_t first_seed, std::size_t& ended) {
  constexpr std::size_t kCount = 7;
  HoverTask task = task_at(ControlLevel::kTrajectory);
  task.episode_s = 0.5;
  VectorEnvironment environments(nominal(), task, {}, kCount, threads);
  std::vector<std::uint64_t> seeds;
  for (std::size_t i = 0; i < kCount; ++i) seeds.push_back(first_seed + i);
  environments.reset(seeds.data());
  std::vector<double> all, observations(kCount * kObservation), last(observations.size()), rewards(kCount);
  bool terminated[kCount], truncated[kCount];
  environments.observe(observations.data());
  for (int i = 0; i < 60; ++i) {
    std::vector<double> actions;
    for (std::size_t j = 0; j < kCount; ++j) {
      const auto row = observations.begin() + static_cast<std::ptrdiff_t>(j * kObservation);
      const std::vector<double> one = towards_target({row, row + static_cast<std::ptrdiff_t>(kObservation)});
      actions.insert(actions.end(), one.begin(), one.end());
    }
    EXPECT_EQ(actions.size(), kCount * kTrajectoryActions);
    environments.step(
        {actions.data(), observations.data(), rewards.data(), terminated, truncated, last.data()});
    all.insert(all.end(), observations.begin(), observations.end());
    all.insert(all.end(), rewards.begin(), rewards.end());
    all.insert(all.end(), last.begin(), last.end());
    for (std::size_t j = 0; j < kCount; ++j) ended += terminated[j] || truncated[j] ? 1 : 0;
  }
  return all;
}

TEST(VectorEnvironment, RepeatsBitForBitWithAnyNumberOfThreads) {
  std::size_t ended = 0, ended_again = 0, ended_of_others = 0;
  const std::vector<double> once = flown(1, 1, ended);
  EXPECT_GE(ended, 14U) << "two episodes of each end";
  EXPECT_EQ(flown(3, 1, ended_again), once);
  EXPECT_NE(flown(3, 100, ended_of_others), once);
}

TEST(VectorEnvironment, RefusesTooManyThreads) {
  for (const std::size_t threads : {std::size_t{0}, VectorEnvironment::kMostThreads + 1})
    EXPECT_THROW(VectorEnvironment(nominal(), task_at(ControlLevel::kRates), {}, 2, threads),
                 std::invalid_argument);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they need the memory themselves
// GIVEN memory for the stacks of a few threads only THEN it works with these.
TEST(VectorEnvironment, WorksWithTheThreadsThatTheSystemStarts) {
  constexpr std::size_t kCount = 64;
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit few = before;
  few.rlim_cur = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + 100'000'000;  // stacks of 8 MB
  ASSERT_EQ(setrlimit(RLIMIT_AS, &few), 0);
  VectorEnvironment environments(nominal(), task_at(ControlLevel::kRates), {}, kCount, kCount);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  environments.reset(std::vector<std::uint64_t>(kCount, 5).data());
  std::vector<double> observations(kCount * kObservation);
  environments.observe(observations.data());
  for (std::size_t i = 1; i < kCount; ++i) {
    for (std::size_t j = 0; j < kObservation; ++j)
      EXPECT_EQ(observations[i * kObservation + j], observations[j]) << i;
  }
}
#endif

// GIVEN two environments in the middle of an episode THEN a copy goes on like them; of those that are not chosen nothing changes.
TEST(VectorEnvironment, IsCopiedWithItsEpisodesAndStepsTheChosenOnes) {
  auto environments =
      std::make_unique<VectorEnvironment>(nominal(), task_at(ControlLevel::kRates), Dispersion{}, 2, 2);
  const std::uint64_t seeds[] = {1, 2};
  environments->reset(seeds);
  const std::vector<double> actions{0.1, 0.2, 0.3, 9.0, 0.3, -0.1, 0.0, 11.0};
  std::vector<double> rewards(2);
  bool terminated[2], truncated[2];
  const auto stepped = [&](VectorEnvironment& of, const bool* chosen) {
    std::vector<double> seen(2 * kObservation), last(2 * kObservation);
    of.step({actions.data(), seen.data(), rewards.data(), terminated, truncated, last.data(), chosen});
    return seen;
  };
  for (int i = 0; i < 5; ++i) stepped(*environments, nullptr);
  VectorEnvironment copy(*environments);
  const std::vector<double> original = stepped(*environments, nullptr);
  environments = nullptr;
  EXPECT_EQ(stepped(copy, nullptr), original);

  const bool second[] = {false, true};
  const std::vector<double> half = stepped(copy, second);
  EXPECT_TRUE(std::equal(half.begin(), half.begin() + kObservation, original.begin()));
  EXPECT_NE(half[kObservation], original[kObservation]);
  EXPECT_EQ(rewards[0], 0.0);
  copy.reset(nullptr, second);
  std::vector<double> seen(2 * kObservation);
  copy.observe(seen.data());
  EXPECT_TRUE(std::equal(seen.begin(), seen.begin() + kObservation, original.begin()));
  EXPECT_NE(seen[kObservation], half[kObservation]);
}

TEST(VectorEnvironment, BeginsTheNextEpisodeInTheStepThatEndsOne) {
  HoverTask task = task_at(ControlLevel::kTrajectory);
  task.episode_s = 0.04;
  VectorEnvironment environments(nominal(), task, {}, 1, 1);
  HoverEnvironment alone(nominal(), task, {});
  const std::uint64_t seed = 9;
  environments.reset(&seed);
  alone.reset(seed);
  const double still[] = {0.0, 0.0, 0.0, 0.0};
  std::vector<double> seen(kObservation), last(kObservation);
  double reward = 0.0;
  bool terminated = false, truncated = false;
  environments.step({still, seen.data(), &reward, &terminated, &truncated, last.data()});
  alone.step(still);
  EXPECT_FALSE(terminated || truncated);
  EXPECT_EQ(last, std::vector<double>(kObservation, 0.0));
  environments.step({still, seen.data(), &reward, &terminated, &truncated, last.data()});
  alone.step(still);
  EXPECT_TRUE(truncated);
  EXPECT_EQ(last, observed(alone));
  alone.reset();
  EXPECT_EQ(seen, observed(alone));
}

}  // namespace swiftlet::simulation::environment_test

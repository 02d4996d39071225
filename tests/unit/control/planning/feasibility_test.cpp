#include "swiftlet/control/planning/feasibility.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::feasibility_test {

constexpr double kSupply_v = 3.7;

const WorstDemand& of(const std::vector<WorstDemand>& all, Demand demand) {
  return all[static_cast<std::size_t>(demand)];
}

std::vector<WorstDemand> survey(const std::vector<PolynomialSegment>& segments, const Limits& limits = {}) {
  return worst_demands(tests::kaylion(), limits, kSupply_v, segments);
}

PolynomialSegment hover() {
  PolynomialSegment segment;
  segment.duration_s = 1.0;
  segment.z[0] = -1.0;
  return segment;
}

// On a circle of radius r at angular rate w about (0, 0, -1), by its Taylor polynomial: exact to 1e-6 over
// 0.5 rad.
PolynomialSegment arc(double r, double w) {
  PolynomialSegment segment = hover();
  segment.duration_s = 0.5 / w;
  double term = r;
  for (std::size_t k = 0; k < 8; ++k) {
    const double sign = (k / 2) % 2 == 0 ? 1.0 : -1.0;
    (k % 2 == 0 ? segment.x : segment.y)[k] = sign * term;
    term *= w / static_cast<double>(k + 1);
  }
  return segment;
}

TEST(Feasibility, HoverRequiresTheWeight) {
  const auto all = survey({hover()});
  const plant::Vehicle& vehicle = tests::kaylion();
  EXPECT_EQ(of(all, Demand::kSpeed).value, 0.0);
  EXPECT_NEAR(of(all, Demand::kLift).value, plant::kGravity, 1e-9);
  EXPECT_NEAR(of(all, Demand::kTilt).value, 0.0, 1e-9);
  EXPECT_NEAR(of(all, Demand::kThrust).value, vehicle.mass_kg * plant::kGravity, 1e-9);
  EXPECT_NEAR(of(all, Demand::kRotorLeast).value, plant::hover_thrust(vehicle), 1e-9);
  EXPECT_NEAR(of(all, Demand::kRotorMost).value, plant::hover_thrust(vehicle), 1e-9);
  EXPECT_NEAR(of(all, Demand::kFence).value, -1.0 - Limits().fence_max_ned.z(), 1e-9);
  for (const WorstDemand& worst : all) EXPECT_FALSE(worst.exceeded()) << worst.sentence();
}

TEST(Feasibility, ArcTiltsByItsCentripetalAcceleration) {
  constexpr double kRadius = 0.5;
  for (const double w : {2.0, 3.6, 3.8}) {
    const auto all = survey({hover(), arc(kRadius, w)});
    const double acceleration = w * w * kRadius;
    EXPECT_NEAR(of(all, Demand::kSpeed).value, w * kRadius, 1e-4);
    EXPECT_NEAR(of(all, Demand::kAcceleration).value, acceleration, 1e-3);
    EXPECT_NEAR(of(all, Demand::kTilt).value, std::atan(acceleration / plant::kGravity), 1e-4);
    EXPECT_EQ(of(all, Demand::kTilt).segment, 1U);
    EXPECT_NEAR(of(all, Demand::kThrust).value,
                tests::kaylion().mass_kg * std::hypot(acceleration, plant::kGravity), 1e-4);
    EXPECT_EQ(of(all, Demand::kTilt).exceeded(),
              acceleration > plant::kGravity * std::tan(Limits().max_tilt_rad));
  }
}

TEST(Feasibility, ReportsEachLimitExactlyAboveItsValue) {
  const std::vector<PolynomialSegment> path = {minimum_jerk({0, 0, -1}, 0.0, {1.5, -1.0, -1.6}, 1.0, 2.0)};
  const auto worst = survey(path);
  const auto exceeded_with = [&](Demand demand, auto set, double factor) {
    Limits limits;
    limits.fence_min_ned = {-9, -9, -9};
    set(limits, factor * of(worst, demand).value);
    return of(survey(path, limits), demand).exceeded();
  };
  const auto expect_sharp = [&](Demand demand, auto set) {
    EXPECT_FALSE(exceeded_with(demand, set, 1.00001)) << to_string(demand);
    EXPECT_TRUE(exceeded_with(demand, set, 0.9999)) << to_string(demand);
  };
  expect_sharp(Demand::kSpeed, [](Limits& l, double v) { l.max_speed = v; });
  expect_sharp(Demand::kAcceleration, [](Limits& l, double v) { l.max_acceleration = v; });
  expect_sharp(Demand::kYawRate, [](Limits& l, double v) { l.max_yaw_rate = v; });
  Limits limits;
  limits.fence_max_ned.x() = 1.5;
  EXPECT_FALSE(of(survey(path, limits), Demand::kFence).exceeded());
  limits.fence_max_ned.x() = 1.4999;
  const WorstDemand fence = of(survey(path, limits), Demand::kFence);
  EXPECT_TRUE(fence.exceeded());
  EXPECT_NEAR(fence.position_ned.x(), 1.5, 1e-9);
  EXPECT_NEAR(fence.time_s, 2.0, 1e-3);
}

TEST(Feasibility, RotorsLimitAFastClimb) {
  // A climb at an acceleration that the four rotors together cannot give.
  const plant::Vehicle& vehicle = tests::kaylion();
  const double most = plant::steady_thrust_range(vehicle, kSupply_v).max * vehicle.rotor_count();
  PolynomialSegment climb = hover();
  climb.duration_s = 0.3;
  climb.z[2] = -0.5 * (1.05 * most / vehicle.mass_kg - plant::kGravity);
  Limits limits;
  limits.max_acceleration = 100.0;
  limits.max_speed = 100.0;
  limits.fence_min_ned.z() = -9.0;
  const auto all = survey({hover(), climb}, limits);
  EXPECT_TRUE(of(all, Demand::kThrust).exceeded());
  EXPECT_TRUE(of(all, Demand::kRotorMost).exceeded());
  EXPECT_FALSE(of(all, Demand::kAcceleration).exceeded());
  EXPECT_EQ(of(all, Demand::kRotorMost).segment, 1U);
  EXPECT_NEAR(of(all, Demand::kRotorMost).value, 1.05 * most / vehicle.rotor_count(), 1e-6);
}

TEST(Feasibility, FindsAShortFreeFall) {
  // A push down: z'' is above 0.9 g for some milliseconds around the middle.
  PolynomialSegment dive = minimum_jerk({0, 0, -2}, 0.0, {0, 0, -1.2}, 0.0, 0.62);
  Limits limits;
  limits.max_acceleration = 100.0;
  limits.max_speed = 100.0;
  const WorstDemand lift = of(survey({dive}, limits), Demand::kLift);
  const double greatest = 10.0 / std::sqrt(3.0) * 0.8 / (0.62 * 0.62);
  EXPECT_NEAR(lift.value, plant::kGravity - greatest, 1e-5);
  EXPECT_TRUE(lift.exceeded());
  EXPECT_NE(lift.sentence().find("upward specific force is -2.2"), std::string::npos) << lift.sentence();
}

TEST(Feasibility, IncludesDrag) {
  plant::Vehicle vehicle = tests::kaylion();
  vehicle.linear_drag = 0.05;
  PolynomialSegment cruise = hover();
  cruise.x[1] = 1.5;
  const auto all = worst_demands(vehicle, Limits(), kSupply_v, {cruise});
  const double backward = vehicle.linear_drag * 1.5 / vehicle.mass_kg;
  EXPECT_NEAR(of(all, Demand::kTilt).value, std::atan(backward / plant::kGravity), 1e-9);
}

TEST(Feasibility, MessageNamesValueLimitAndPosition) {
  WorstDemand worst{Demand::kTilt, 0.713, 0.6, 3, 3.2, {0.1, 0.2, -1.0}};
  EXPECT_EQ(worst.sentence(),
            "tilt is 0.713 rad, the limit is 0.600 rad: at 3.20 s, segment 4, (0.10, 0.20, -1.00) m NED");
  EXPECT_TRUE(worst.exceeded());
}

}  // namespace swiftlet::control::feasibility_test

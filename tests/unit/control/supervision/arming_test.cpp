#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/control/placed_flight.hpp"

namespace swiftlet::control::arming_test {

// An arming check: accepted at its limit, refused with a sentence just beyond it.
struct ArmingLimit {
  const char* name;
  std::function<void(Placed&)> good;
  std::function<void(Placed&)> bad;
  const char* sentence;
};
void PrintTo(const ArmingLimit& limit, std::ostream* out) { *out << limit.name; }

class Arming : public testing::TestWithParam<ArmingLimit> {};

TEST_P(Arming, IsRefusedBeyondTheLimitWithValueAndLimit) {
  const ArmingLimit& limit = GetParam();
  Placed good(kLand);
  limit.good(good);
  const Outcome accepted = good.ask(RequestKind::kArm);
  EXPECT_TRUE(accepted.accepted) << accepted.reason;
  Placed bad(kLand);
  limit.bad(bad);
  const Outcome refused = bad.ask(RequestKind::kArm);
  EXPECT_FALSE(refused.accepted);
  EXPECT_EQ(std::string(refused.reason), std::string("cannot arm: ") + limit.sentence);
  EXPECT_EQ(bad.mode(), Mode::kDisarmed);
}

const auto kNothing = [](Placed&) {};
void tilt(Placed& flight, double angle_rad) {
  flight.estimate_.q_ned_from_frd = Eigen::AngleAxisd(angle_rad, Vector3d::UnitX());
  flight.inputs_.specific_force_frd =
      flight.estimate_.q_ned_from_frd.conjugate() * Vector3d(0.0, 0.0, -plant::kGravity);
}
const ArmingLimit kArmingLimits[] = {
    {"pose", kNothing, [](Placed& f) { f.inputs_.has_estimate = false; }, "no mocap pose received"},
    {"pose age", [](Placed& f) { f.inputs_.pose_age_s = 0.5; },
     [](Placed& f) { f.inputs_.pose_age_s = 0.51; },
     "the last mocap pose is 0.51 s old, the limit is 0.50 s"},
    {"pose fault", [](Placed& f) { f.estimate_.pose_fault = PoseFault::kUntimely; },
     [](Placed& f) { f.estimate_.pose_fault = PoseFault::kFrozen; },
     "the last mocap pose was refused: frozen"},
    {"imu", kNothing, [](Placed& f) { f.inputs_.imu_unusable_s = 0.002; }, "IMU samples are not usable"},
    {"battery", kNothing, [](Placed& f) { f.inputs_.has_battery = false; }, "no battery voltage received"},
    {"battery age", [](Placed& f) { f.inputs_.battery_age_s = 2.0; },
     [](Placed& f) { f.inputs_.battery_age_s = 2.1; },
     "the last battery voltage is 2.1 s old, the limit is 2.0 s"},
    {"voltage", [](Placed& f) { f.inputs_.supply_voltage_v = 3.3; },
     [](Placed& f) { f.inputs_.supply_voltage_v = 3.29; },
     "battery voltage 3.29 V is too low; minimum is 3.30 V"},
    {"specific force",
     [](Placed& f) {
       f.inputs_.specific_force_frd = {0.6, 0.0, -plant::kGravity - 0.79};
     },
     [](Placed& f) {
       f.inputs_.specific_force_frd = {0.0, 0.0, -plant::kGravity + 1.01};
     },
     "the accelerometer is 1.01 m/s^2 off gravity in the attitude of the pose, the limit is 1.00 m/s^2"},
    {"tilt of the pose alone", kNothing,
     [](Placed& f) { f.estimate_.q_ned_from_frd = Eigen::AngleAxisd(0.15, Vector3d::UnitX()); },
     "the accelerometer is 1.47 m/s^2 off gravity in the attitude of the pose, the limit is 1.00 m/s^2"},
    {"rates",
     [](Placed& f) {
       f.estimate_.body_rates_frd = {0.0, 0.2, 0.0};
     },
     [](Placed& f) {
       f.estimate_.body_rates_frd = {0.2, 0.2, 0.1};
     },
     "turning at 0.30 rad/s, the limit is 0.20 rad/s"},
    {"rotors", [](Placed& f) { f.inputs_.rotor_speed = 100.0; },
     [](Placed& f) { f.inputs_.rotor_speed = 101.0; }, "a rotor turns at 101 rad/s, the limit is 100 rad/s"},
    {"tilt", [](Placed& f) { tilt(f, 0.349); }, [](Placed& f) { tilt(f, 0.36); },
     "tilted by 0.36 rad, the limit is 0.35 rad"},
    {"speed",
     [](Placed& f) {
       f.estimate_.velocity_ned = {0.0, 0.0, 0.3};
     },
     [](Placed& f) {
       f.estimate_.velocity_ned = {0.0, 0.0, 0.31};
     },
     "moving at 0.31 m/s, the limit is 0.30 m/s"},
    {"fence", [](Placed& f) { f.estimate_.position_ned.x() = 3.0; },
     [](Placed& f) { f.estimate_.position_ned.x() = 3.01; },
     "the vehicle: x is 3.010 m, outside the fence of -3.000 to 3.000 m"},
};
INSTANTIATE_TEST_SUITE_P(Checks, Arming, testing::ValuesIn(kArmingLimits));

TEST(ArmingRefusal, ListsAllReasonsInWholeSentences) {
  Placed flight(kLand);
  flight.inputs_.has_battery = false;
  flight.estimate_.velocity_ned.x() = 1.0;
  EXPECT_STREQ(flight.ask(RequestKind::kArm).reason,
               "cannot arm: no battery voltage received; moving at 1.00 m/s, the limit is 0.30 m/s");
  for (const ArmingLimit& limit : kArmingLimits) limit.bad(flight);
  const std::string all = flight.ask(RequestKind::kArm).reason;
  EXPECT_LT(all.size(), sizeof Outcome().reason);
  std::size_t sentences = 0;
  std::string rest = all.substr(std::string("cannot arm: ").size());
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find("; "), rest.size());
    const std::string sentence = rest.substr(0, end);
    EXPECT_TRUE(std::any_of(std::begin(kArmingLimits), std::end(kArmingLimits),
                            [&](const ArmingLimit& limit) { return sentence == limit.sentence; }))
        << sentence;
    rest = end == rest.size() ? "" : rest.substr(end + 2);
    ++sentences;
  }
  EXPECT_GE(sentences, 3U);
}

}  // namespace swiftlet::control::arming_test

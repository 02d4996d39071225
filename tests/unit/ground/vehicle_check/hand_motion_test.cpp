#include "swiftlet/ground/vehicle_check/hand_motion.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/vehicle_check/motion_watch.hpp"
#include "tests/unit/ground/vehicle_check/expect_results.hpp"
#include "tests/unit/ground/vehicle_check/recorded_vehicle.hpp"

namespace swiftlet::tests::hand_motion_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using ground::CheckResults;
using ground::HandStep;

CheckResults check(const RecordedHand& hand) {
  return ground::check_hand_motion(hand.motion, hand.segments, hand.rest);
}

template <class Change>
void change_imu(RecordedHand& hand, Change change) {
  for (auto* recording : {&hand.rest, &hand.motion}) {
    for (auto& received : recording->imu.samples) change(received.sample.imu);
  }
}
template <class Change>
void change_poses(RecordedHand& hand, Change change) {
  for (auto* recording : {&hand.rest, &hand.motion}) {
    for (auto& received : recording->mocap.samples) change(received.sample);
  }
}

struct Defect {
  std::string name;
  std::function<void(RecordedHand&)> seed;
  std::string check;
  std::string words;
};

// A 16-bit value that overflows at +-range.
double wrapped(double value, double range) {
  return value - 2.0 * range * std::floor((value + range) / (2.0 * range));
}

std::vector<Defect> defects() {
  const auto imu = [](auto change) { return [change](RecordedHand& hand) { change_imu(hand, change); }; };
  const auto poses = [](auto change) { return [change](RecordedHand& hand) { change_poses(hand, change); }; };
  return {
      {"gyro reversed", imu([](plant::ImuSample& it) { it.body_rates_frd *= -1.0; }), "hand.gyro",
       "gyro: all signs are reversed"},
      {"sign of q", imu([](plant::ImuSample& it) { it.body_rates_frd.y() *= -1.0; }), "hand.gyro",
       "gyro: the sign of y is reversed"},
      {"gyro FLU", imu([](plant::ImuSample& it) { it.body_rates_frd.tail<2>() *= -1.0; }), "hand.gyro",
       "gyro: y and z are reversed: the axes are Forward-Left-Up (FLU)"},
      {"gyro axes swapped",
       imu([](plant::ImuSample& it) { std::swap(it.body_rates_frd.x(), it.body_rates_frd.y()); }),
       "hand.gyro", "gyro: x and y are exchanged"},
      {"gyro turned", imu([](plant::ImuSample& it) {
         it.body_rates_frd = Vector3d(-it.body_rates_frd.y(), it.body_rates_frd.x(), it.body_rates_frd.z());
       }),
       "hand.gyro", "gyro: the axes are turned: x shows -y, y shows x, z shows z"},
      {"gyro in degrees/s", imu([](plant::ImuSample& it) { it.body_rates_frd *= 180.0 / M_PI; }),
       "hand.gyro_scale", "gyro in degrees/s"},
      {"gyro of half the range", imu([](plant::ImuSample& it) { it.body_rates_frd *= 0.5; }),
       "hand.gyro_scale", "gyro has a wrong scale: it shows 0."},
      {"gyro dead", imu([](plant::ImuSample& it) { it.body_rates_frd.setZero(); }), "hand.gyro",
       "do not show the axes of the gyro clearly"},
      {"accelerometer reversed", imu([](plant::ImuSample& it) { it.specific_force_frd *= -1.0; }),
       "hand.accelerometer", "accelerometer: all signs are reversed"},
      {"accelerometer FLU", imu([](plant::ImuSample& it) { it.specific_force_frd.tail<2>() *= -1.0; }),
       "hand.accelerometer", "accelerometer: y and z are reversed: the axes are Forward-Left-Up (FLU)"},
      {"accelerometer axes swapped",
       imu([](plant::ImuSample& it) { std::swap(it.specific_force_frd.x(), it.specific_force_frd.y()); }),
       "hand.accelerometer", "accelerometer: x and y are exchanged"},
      {"16-bit wrap-around", imu([](plant::ImuSample& it) {
         for (double& rate : it.body_rates_frd) rate = wrapped(rate, 4.36);
       }),
       "imu.wrap_around", "16-bit wrap-around: gyro "},
      {"saturation", imu([](plant::ImuSample& it) {
         for (double& rate : it.body_rates_frd) rate = std::clamp(rate, -4.36, 4.36);
       }),
       "imu.saturation", "saturates at 4.36 rad/s"},
      {"IMU stamps late", imu([](plant::ImuSample& it) { it.stamp_ns += 40'000'000; }), "hand.delay",
       "late IMU stamps: they are "},
      {"motion capture stamped at arrival", poses([](plant::PoseSample& it) { it.stamp_ns += 40'000'000; }),
       "hand.delay", "motion capture delayed: its stamps are "},
      {"another body", poses([](plant::PoseSample& it) {
         it.q_ned_from_frd.setIdentity();
         it.position_ned.setZero();
       }),
       "hand.mocap_attitude", "do not show the axes of the motion capture attitude clearly"},
      {"motion capture ENU", poses([](plant::PoseSample& it) {
         it.position_ned = Vector3d(it.position_ned.y(), it.position_ned.x(), -it.position_ned.z());
         it.q_ned_from_frd = Quaterniond(0.0, M_SQRT1_2, M_SQRT1_2, 0.0) * it.q_ned_from_frd *
                             Quaterniond(0.0, 1.0, 0.0, 0.0);
       }),
       "hand.mocap_up", "motion capture in ENU: z rises"},
      {"motion capture FLU", poses([](plant::PoseSample& it) {
         it.q_ned_from_frd = Quaterniond(0.0, M_SQRT1_2, M_SQRT1_2, 0.0) * it.q_ned_from_frd *
                             Quaterniond(0.0, 1.0, 0.0, 0.0);
       }),
       "hand.mocap_attitude", "Forward-Left-Up (FLU)"},
      {"position alone in ENU", poses([](plant::PoseSample& it) {
         it.position_ned = Vector3d(it.position_ned.y(), it.position_ned.x(), -it.position_ned.z());
       }),
       "hand.mocap_forward", "position and attitude are in different frames"},
      {"motion capture in mm", poses([](plant::PoseSample& it) { it.position_ned *= 1e-3; }), "hand.mocap_up",
       "wrong unit"},
      {"motion capture misaligned", poses([](plant::PoseSample& it) {
         it.q_ned_from_frd = it.q_ned_from_frd * Quaterniond(Eigen::AngleAxisd(0.2, Vector3d::UnitZ()));
       }),
       "hand.alignment", "misaligned by 11 degrees"},
      {"a step is missing", [](RecordedHand& hand) { hand.segments.pop_back(); }, "hand.steps",
       "missing: the motion \"quick turns\""},
      {"motion capture lost", poses([](plant::PoseSample& it) { it.tracked = false; }), "hand.gyro_scale",
       "missing: motion capture shows no turn"},
  };
}

TEST(HandMotion, PassesEveryCheckAsItShouldBe) { expect_sound(check(record_hand())); }

TEST(HandMotion, EachDefectIsCaughtAndNamed) {
  const RecordedHand sound = record_hand();
  for (const Defect& defect : defects()) {
    SCOPED_TRACE(defect.name);
    RecordedHand hand = sound;
    defect.seed(hand);
    expect_names(check(hand), defect.check, defect.words);
  }
}

TEST(HandMotion, MeasuresTheDelayToTheMillisecond) {
  RecordedHand hand = record_hand();
  change_poses(hand, [](plant::PoseSample& pose) { pose.stamp_ns += 8'000'000; });
  for (const ground::CheckResult& result : check(hand)) {
    if (result.name == "hand.delay") {
      EXPECT_NEAR(result.figure.value, 8.0, 2.0);
    }
  }
  EXPECT_TRUE(ground::passes(check(hand), "hand.delay"));
}

TEST(MotionWatch, FindsEachMotionBetweenItsRests) {
  const RecordedHand hand = record_hand();
  auto next = hand.motion.mocap.samples.begin();
  ground::MotionWatch watch;
  for (const ground::HandSegment& expected : hand.segments) {
    watch.expect(expected.step);
    std::optional<ground::HandSegment> found;
    for (; next != hand.motion.mocap.samples.end() && !found; ++next)
      found = watch.update(next->sample, next->received_ns);
    ASSERT_TRUE(found) << static_cast<int>(expected.step);
    EXPECT_GE(found->begin_ns, expected.begin_ns - 400'000'000);
    EXPECT_LE(found->end_ns, expected.end_ns + 20'000'000);
  }
}

TEST(MotionWatch, DoesNotTakeRestForAMotion) {
  const ground::VehicleRecording rest = record_standing();
  for (const HandStep step : {HandStep::kRollRight, HandStep::kForward, HandStep::kWave}) {
    ground::MotionWatch watch;
    watch.expect(step);
    for (const auto& pose : rest.mocap.samples) EXPECT_FALSE(watch.update(pose.sample, pose.received_ns));
    EXPECT_TRUE(watch.is_ready());
  }
}

}  // namespace swiftlet::tests::hand_motion_test

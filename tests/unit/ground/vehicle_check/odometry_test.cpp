// The checks of a standing vehicle that brings an estimate of its own in place of IMU samples.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/ground/vehicle_check/standing_vehicle.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "tests/unit/ground/vehicle_check/expect_results.hpp"
#include "tests/unit/ground/vehicle_check/recorded_vehicle.hpp"

namespace swiftlet::tests::odometry_test {

using ground::CheckResults;
using ground::VehicleRecording;

// The standing vehicle with its IMU samples replaced.
VehicleRecording standing() {
  VehicleRecording recording = record_standing();
  for (const auto& received : recording.imu.samples) {
    plant::OdometrySample sample;
    sample.stamp_ns = received.sample.imu.stamp_ns;
    sample.sequence = received.sample.imu.sequence;
    sample.position_valid = sample.velocity_valid = true;
    sample.velocity_ned = {0.001, 0.002, 0.0};
    recording.odometry.samples.push_back({{sample, received.sample.obeyed, false}, received.received_ns});
  }
  recording.odometry.published = true;
  recording.imu = {};
  return recording;
}

CheckResults check(const VehicleRecording& recording) {
  const plant::Vehicle vehicle = kaylion();
  return ground::check_standing_vehicle(recording, &vehicle, true);
}

TEST(OdometryAtRest, PassesAllChecks) {
  const CheckResults results = check(standing());
  for (const auto& result : results)
    EXPECT_NE(result.verdict, ground::Verdict::kFail) << result.name << ": " << result.finding;
  EXPECT_TRUE(ground::passes(results, "vehicle_odometry.rate"));
  EXPECT_TRUE(ground::passes(results, "vehicle_odometry.mocap"));
  EXPECT_TRUE(ground::passes(results, "battery.age")) << "by the stamps of the estimate";
}

struct Defect {
  const char* check;
  const char* words;
  std::function<void(plant::OdometrySample&)> seed;
};

TEST(OdometryAtRest, DefectsAreNamed) {
  const Defect defects[] = {
      {"vehicle_odometry.valid", "does not know its position", [](auto& it) { it.position_valid = false; }},
      {"vehicle_odometry.level", "upside down",
       [](auto& it) { it.q_ned_from_frd = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0); }},
      {"vehicle_odometry.level", "Components in another order",
       [](auto& it) { it.q_ned_from_frd = math::rotation(Eigen::Vector3d(0.0, 0.5, 0.0)); }},
      {"vehicle_odometry.speed", "moves although the vehicle stands",
       [](auto& it) { it.velocity_ned.x() = 0.4; }},
      {"vehicle_odometry.rates", "degrees/s", [](auto& it) { it.body_rates_frd.z() = 0.6; }},
      {"vehicle_odometry.resets", "jumps while it stands",
       [](auto& it) { it.resets = static_cast<std::uint32_t>(it.sequence / 100); }},
      {"vehicle_odometry.mocap", "differ in tilt",
       [](auto& it) { it.q_ned_from_frd = math::rotation(Eigen::Vector3d(0.12, 0.0, 0.0)); }},
      {"vehicle_odometry.stamps", "frozen stamps", [](auto& it) { it.stamp_ns = 1; }},
  };
  for (const Defect& defect : defects) {
    VehicleRecording recording = standing();
    for (auto& received : recording.odometry.samples) defect.seed(received.sample.odometry);
    SCOPED_TRACE(defect.words);
    expect_names(check(recording), defect.check, defect.words);
  }
}

}  // namespace swiftlet::tests::odometry_test

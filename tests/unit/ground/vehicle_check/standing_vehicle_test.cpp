#include "swiftlet/ground/vehicle_check/standing_vehicle.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/vehicle_check/streams.hpp"
#include "swiftlet/math/random.hpp"
#include "tests/unit/ground/vehicle_check/expect_results.hpp"
#include "tests/unit/ground/vehicle_check/recorded_vehicle.hpp"

namespace swiftlet::tests::standing_vehicle_test {

using ground::CheckResults;
using ground::VehicleRecording;

constexpr double kGravity = plant::kGravity;

CheckResults check(const VehicleRecording& recording) {
  const plant::Vehicle vehicle = kaylion();
  return ground::check_standing_vehicle(recording, &vehicle, true);
}

// A defect of a vehicle, put into what it publishes, and what has to be said about it.
struct Defect {
  std::string name;
  std::function<void(VehicleRecording&)> seed;
  std::string check;
  std::string words;
};

template <class Change>
std::function<void(VehicleRecording&)> each_imu(Change change) {
  return [change](VehicleRecording& recording) {
    for (auto& received : recording.imu.samples) change(received.sample.imu);
  };
}
template <class Change>
std::function<void(VehicleRecording&)> each_pose(Change change) {
  return [change](VehicleRecording& recording) {
    for (auto& received : recording.mocap.samples) change(received.sample);
  };
}

template <class Samples>
void keep_every(Samples& samples, std::size_t n) {
  Samples kept;
  for (std::size_t i = 0; i < samples.size(); i += n) kept.push_back(samples[i]);
  samples = kept;
}

void repeat_every_tenth(VehicleRecording& recording) {
  auto& samples = recording.imu.samples;
  for (std::size_t i = samples.size() - 1; i > 0; i -= std::min<std::size_t>(i, 10))
    samples.insert(samples.begin() + static_cast<std::ptrdiff_t>(i), samples[i]);
}

void hold_values(VehicleRecording& recording) {
  auto& samples = recording.imu.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const plant::ImuSample& held = samples[i - i % 2].sample.imu;
    samples[i].sample.imu.specific_force_frd = held.specific_force_frd;
    samples[i].sample.imu.body_rates_frd = held.body_rates_frd;
  }
}

void number_again(VehicleRecording& recording) {
  std::uint64_t number = 0;
  for (auto& received : recording.imu.samples) received.sample.imu.sequence = ++number;
}

void make_stamps_irregular(VehicleRecording& recording) {
  math::RandomStream random(1, 1);
  for (auto& received : recording.imu.samples)
    received.sample.imu.stamp_ns += static_cast<std::int64_t>(random.uniform(0.0, 1.9e6));
}

void deliver_in_bursts(VehicleRecording& recording) {
  auto& samples = recording.imu.samples;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].received_ns = samples[std::min(i - i % 25 + 24, samples.size() - 1)].received_ns;
}

std::vector<Defect> defects() {
  const Eigen::AngleAxisd misaligned(0.2, Eigen::Vector3d::UnitX());
  return {
      {"nothing arrives",
       [](VehicleRecording& it) {
         it.imu.samples.clear();
         it.imu.published = false;
       },
       "imu.received", "missing: nobody publishes imu"},
      {"QoS differs or silent", [](VehicleRecording& it) { it.imu.samples.clear(); }, "imu.received",
       "missing: imu is published, but 0 messages arrived"},
      {"no battery", [](VehicleRecording& it) { it.battery.samples.clear(); }, "battery.received",
       "missing: battery"},
      {"no motion capture", [](VehicleRecording& it) { it.mocap.samples.clear(); }, "mocap_pose.received",
       "missing: mocap_pose"},
      {"NaN",
       [](VehicleRecording& it) {
         it.imu.invalid = 3;
         it.imu.fault = "body_rates_frd is not finite";
       },
       "imu.received", "3 messages are invalid and not used by control: body_rates_frd is not finite"},
      {"two vehicles", [](VehicleRecording& it) { it.imu.conflict = "a and b"; }, "imu.received",
       "two processes publish imu: a and b"},
      {"accelerometer in g", each_imu([](plant::ImuSample& it) { it.specific_force_frd /= kGravity; }),
       "imu.gravity", "accelerometer in g: |specific force| is "},
      {"accelerometer in mg", each_imu([](plant::ImuSample& it) { it.specific_force_frd *= 1e3 / kGravity; }),
       "imu.gravity", "accelerometer in thousandths of g"},
      {"raw counts", each_imu([](plant::ImuSample& it) { it.specific_force_frd *= 4096.0 / kGravity; }),
       "imu.gravity", "accelerometer in counts of a 16-bit sensor"},
      {"gravity subtracted", each_imu([](plant::ImuSample& it) { it.specific_force_frd.z() += kGravity; }),
       "imu.gravity", "does not measure gravity"},
      {"sign of the accelerometer", each_imu([](plant::ImuSample& it) { it.specific_force_frd *= -1.0; }),
       "imu.level", "sign of the accelerometer reversed, or axes FLU"},
      {"FLU", each_imu([](plant::ImuSample& it) { it.specific_force_frd.tail<2>() *= -1.0; }), "imu.level",
       "axes FLU (z up) instead of FRD"},
      {"axes swapped", each_imu([](plant::ImuSample& it) {
         std::swap(it.specific_force_frd.x(), it.specific_force_frd.z());
       }),
       "imu.level", "axes swapped: gravity is on -x instead of -z"},
      {"gyro in degrees/s", each_imu([](plant::ImuSample& it) { it.body_rates_frd *= 180.0 / M_PI; }),
       "imu.gyro", "gyro in degrees/s"},
      {"stamps in us", each_imu([](plant::ImuSample& it) { it.stamp_ns /= 1000; }), "imu.clock",
       "stamps in us"},
      {"stamps in ms", each_imu([](plant::ImuSample& it) { it.stamp_ns /= 1'000'000; }), "imu.clock",
       "stamps in ms"},
      {"frozen stamps", each_imu([](plant::ImuSample& it) { it.stamp_ns = 5; }), "imu.stamps",
       "frozen stamps"},
      {"late stamps", each_imu([](plant::ImuSample& it) { it.stamp_ns -= 60'000'000; }), "imu.age",
       "late stamps: a sample is 60 ms old"},
      {"stamps in the future", each_imu([](plant::ImuSample& it) { it.stamp_ns += 60'000'000; }), "imu.age",
       "in the future"},
      {"irregular stamps", make_stamps_irregular, "imu.jitter", "the stamps are irregular"},
      {"bursts", deliver_in_bursts, "imu.delivery", "delivered in bursts or late"},
      {"duplicate samples", repeat_every_tenth, "imu.sequence", "duplicate samples: "},
      {"lost samples", [](VehicleRecording& it) { keep_every(it.imu.samples, 2); }, "imu.sequence", "gaps: "},
      {"a gap",
       [](VehicleRecording& it) {
         auto& all = it.imu.samples;
         all.erase(all.begin() + 400, all.begin() + 500);
       },
       "imu.gap", "gaps: no sample for 202 ms"},
      {"half the rate",
       [](VehicleRecording& it) {
         keep_every(it.imu.samples, 2);
         number_again(it);
       },
       "imu.rate", "half the declared rate: 250 Hz instead of 500 Hz"},
      {"values held", hold_values, "imu.values", "the sensor is read slower than imu is published"},
      {"shaken",
       each_imu([](plant::ImuSample& it) { it.specific_force_frd.x() += it.sequence % 2 == 0 ? 2.0 : -2.0; }),
       "imu.still", "does not stand still"},
      {"battery in mV",
       [](VehicleRecording& it) {
         for (auto& one : it.battery.samples) one.sample.voltage_v *= 1e3;
       },
       "battery.voltage", "battery in mV: voltage_v is 4100"},
      {"battery not connected",
       [](VehicleRecording& it) {
         for (auto& one : it.battery.samples) one.sample.voltage_v = 0.0;
       },
       "battery.voltage", "is not measured"},
      {"battery of two cells",
       [](VehicleRecording& it) {
         for (auto& one : it.battery.samples) one.sample.voltage_v *= 2.0;
       },
       "battery.voltage", "another battery, of 2 times the cells"},
      {"battery too slow", [](VehicleRecording& it) { keep_every(it.battery.samples, 6); }, "battery.rate",
       "too slow"},
      {"battery with another clock",
       [](VehicleRecording& it) {
         for (auto& one : it.battery.samples) one.sample.stamp_ns += 1'600'000'000'000'000'000;
       },
       "battery.age", "not those of the vehicle's clock"},
      {"motion capture delayed",
       [](VehicleRecording& it) {
         for (auto& one : it.mocap.samples) one.received_ns += 150'000'000;
       },
       "mocap_pose.age", "late stamps: a sample is 16"},
      {"motion capture ENU", each_pose([](plant::PoseSample& it) {
         it.q_ned_from_frd = Eigen::Quaterniond(0.0, M_SQRT1_2, M_SQRT1_2, 0.0) * it.q_ned_from_frd;
       }),
       "mocap_pose.gravity", "upside down against gravity: ENU or FLU"},
      {"motion capture y up", each_pose([](plant::PoseSample& it) {
         it.q_ned_from_frd = Eigen::Quaterniond(M_SQRT1_2, M_SQRT1_2, 0.0, 0.0) * it.q_ned_from_frd;
       }),
       "mocap_pose.gravity", "turned by about 90 degrees"},
      {"motion capture misaligned",
       each_pose([misaligned](plant::PoseSample& it) { it.q_ned_from_frd = it.q_ned_from_frd * misaligned; }),
       "mocap_pose.gravity", "misaligned by 11."},
      {"motion capture stuck", each_pose([](plant::PoseSample& it) {
         it.position_ned.setZero();
         it.q_ned_from_frd.setIdentity();
       }),
       "mocap_pose.values", "poses repeat bit for bit"},
      {"motion capture in mm", each_pose([](plant::PoseSample& it) { it.position_ned *= 1e3; }),
       "mocap_pose.still", "wrong unit"},
      {"markers hidden", each_pose([](plant::PoseSample& it) { it.tracked = it.sequence % 3 == 0; }),
       "mocap_pose.tracked", "does not see the vehicle"},
      {"another vehicle", [](VehicleRecording& it) { it.description->rotor_count = 6; },
       "vehicle_info.rotors", "has 6 rotors"},
      {"another vehicle", [](VehicleRecording& it) { it.description->name = "lab25"; }, "vehicle_info.name",
       "the vehicle is lab25, not kaylion"},
      {"two cells, full", [](VehicleRecording& it) { it.description->full_battery_v = 8.38; },
       "vehicle_info.full_battery", "another battery"},
      {"two cells, empty", [](VehicleRecording& it) { it.description->empty_battery_v = 5.3; },
       "vehicle_info.empty_battery", "another battery"},
      {"mass in grams", [](VehicleRecording& it) { it.description->mass_kg = 40.0; }, "vehicle_info.mass",
       "mass in grams"},
      {"lockstep",
       [](VehicleRecording& it) {
         it.description->simulated = true;
         it.imu.samples.front().sample.lockstep = true;
       },
       "imu.lockstep", "start it in real time"},
  };
}

TEST(StandingVehicle, PassesEveryCheckAsItShouldBe) { expect_sound(check(record_standing())); }

TEST(StandingVehicle, EachDefectIsCaughtAndNamed) {
  const VehicleRecording sound = record_standing();
  for (const Defect& defect : defects()) {
    SCOPED_TRACE(defect.name);
    VehicleRecording recording = sound;
    defect.seed(recording);
    expect_names(check(recording), defect.check, defect.words);
  }
}

TEST(StandingVehicle, OptionalTopicsAreSkippedWithTheReason) {
  VehicleRecording recording = record_standing();
  recording.rotor_speeds = {};
  recording.mocap = {};
  recording.description.reset();
  recording.clock.clear();
  const plant::Vehicle vehicle = kaylion();
  const CheckResults results = ground::check_standing_vehicle(recording, &vehicle, false);
  expect_sound(results, {"imu.age", "rotor_speeds.received", "mocap_pose.received", "vehicle_info.received"});
}

TEST(StandingVehicle, ARateThatIsNotDeclaredMustBeOneOfTheContract) {
  VehicleRecording recording = record_standing();
  recording.description->imu_rate_hz = 0.0;
  expect_sound(check(recording));
  keep_every(recording.imu.samples, 2);
  number_again(recording);
  expect_names(check(recording), "imu.rate", "half the required rate");
}

// GIVEN a vehicle with an IMU of 100 Hz, as PX4 sends it, whose battery is stamped up to a period after the newest sample THEN it
// is sound if it closes the inner loops itself, but not at less than 100 Hz, and not at level actuators.
TEST(StandingVehicle, ThatClosesTheInnerLoopsNeedsAHundredSamplesASecond) {
  VehicleRecording recording = record_standing();
  const double rate_hz = recording.description->imu_rate_hz;
  keep_every(recording.imu.samples, static_cast<std::size_t>(rate_hz / 100.0));
  number_again(recording);
  for (auto& received : recording.battery.samples) received.sample.stamp_ns += 10'000'000;
  recording.description->imu_rate_hz = 100.0;
  expect_names(check(recording), "imu.rate", "declares 100 Hz: the controller needs 500 or 1000 Hz");
  recording.description->levels = plant::ControlLevel::kRates;
  expect_sound(check(recording));
  recording.description->imu_rate_hz = 50.0;
  expect_names(check(recording), "imu.rate", "declares 50 Hz: the controller needs 100 Hz or more");
}

TEST(StandingVehicle, ASimulatedVehicleMayRunFasterThanTheClock) {
  VehicleRecording recording = record_standing();
  for (auto& received : recording.imu.samples)
    received.received_ns = recording.begin_ns + (received.received_ns - recording.begin_ns) / 2;
  expect_names(check(recording), "imu.clock", "do not run with the clock");
  EXPECT_EQ(ground::vehicle_rate(recording), 1.0) << "a faulty clock is no time";
  recording.description->simulated = true;
  EXPECT_TRUE(ground::passes(check(recording), "imu.clock"));
  EXPECT_NEAR(ground::vehicle_rate(recording), 2.0, 0.01);
  recording = record_standing();
  recording.description->simulated = true;
  EXPECT_EQ(ground::vehicle_rate(recording), 1.0) << "this computer's clock is exact";
}

// GIVEN samples that all come 30 ms later from the middle on THEN a real vehicle is late, and a simulated one has paused; bursts
// of one that did not pause are found.
TEST(StandingVehicle, ASimulatedVehicleMayPause) {
  VehicleRecording recording = record_standing();
  const std::int64_t pause_ns = recording.begin_ns + std::llround(0.5e9 * recording.duration_s());
  for (auto& received : recording.imu.samples)
    if (received.received_ns >= pause_ns) received.received_ns += 30'000'000;
  expect_names(check(recording), "imu.delivery", "delivered in bursts or late");
  recording.description->simulated = true;
  expect_sound(check(recording), {"imu.delivery", "imu.age"});
  recording = record_standing();
  recording.description->simulated = true;
  deliver_in_bursts(recording);
  expect_names(check(recording), "imu.delivery", "delivered in bursts or late");
}

TEST(StandingVehicle, NothingPassesWithoutData) {
  for (const ground::CheckResult& result : check({}))
    EXPECT_NE(result.verdict, ground::Verdict::kPass) << result.name;
}

}  // namespace swiftlet::tests::standing_vehicle_test

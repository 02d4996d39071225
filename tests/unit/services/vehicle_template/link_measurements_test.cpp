#include "swiftlet/services/vehicle_template/link_measurements.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace swiftlet::services::link_measurements_test {

protocol::State state(bool rotors_running, std::uint32_t commands_obeyed) {
  protocol::State out;
  out.rotors_running = rotors_running ? 1 : 0;
  out.commands_obeyed = commands_obeyed;
  return out;
}

protocol::Imu sample(std::int64_t stamp_us) {
  protocol::Imu out;
  out.stamp_us = stamp_us;
  return out;
}

TEST(LinkMeasurements, CountsAnswersSinceTheRotorsStarted) {
  LinkMeasurements measurements;
  measurements.note(state(false, 100));
  measurements.note(sample(1), 3'000);
  measurements.note(state(true, 101));
  EXPECT_EQ(measurements.samples, 0U);
  for (std::int64_t stamp_us = 2; stamp_us < 12; ++stamp_us)
    measurements.note(sample(stamp_us), std::nullopt);
  measurements.note(state(true, 108));
  EXPECT_EQ(measurements.samples, 10U);
  EXPECT_EQ(measurements.answered, 7U);
}

// Its numbers begin again: they are lower than when the rotors started last.
TEST(LinkMeasurements, ARestartedMicrocontrollerHasAnsweredNothing) {
  LinkMeasurements measurements;
  measurements.note(state(false, 100));
  measurements.note(state(true, 101));
  for (std::int64_t stamp_us = 2; stamp_us < 12; ++stamp_us)
    measurements.note(sample(stamp_us), std::nullopt);
  measurements.note(state(false, 0));
  EXPECT_EQ(measurements.answered, 0U);
}

TEST(LinkMeasurements, MeasuresEachObeyedCommandOnce) {
  LinkMeasurements measurements;
  protocol::HelloReply microcontroller;
  microcontroller.imu_rate_hz = 500;
  measurements.link.microcontroller = microcontroller;
  protocol::Imu in = sample(10'000);
  measurements.note(in, 10'250'000);
  EXPECT_EQ(measurements.sample_to_host.max_ns(), 250'000);
  EXPECT_EQ(measurements.sample_to_motor.count(), 0U) << "no command yet";
  in.has_command = 1;
  in.command_stamp_us = 9'000;
  in.command_age_us = 2'001;
  measurements.note(in, std::nullopt);
  measurements.note(in, std::nullopt);
  EXPECT_EQ(measurements.sample_to_motor.count(), 1U);
  EXPECT_EQ(measurements.sample_to_motor.max_ns(), 2'001'000);
  EXPECT_EQ(measurements.late, 1U) << "later than 2 ms";
}

}  // namespace swiftlet::services::link_measurements_test

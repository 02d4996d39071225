#include "swiftlet/services/vehicle_template/wire.hpp"

#include <array>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace swiftlet::services::wire_test {

TEST(Wire, AnImuSampleKeepsItsStampsAndReportsTheObeyedCommand) {
  protocol::Imu in;
  in.stamp_us = 1'234'567'890'123;
  in.specific_force_frd = {1.0F, 2.0F, -9.75F};
  in.body_rates_frd = {0.5F, -0.25F, 0.125F};
  EXPECT_EQ(to_message(in).obeyed().state(), messages::msg::ObeyedCommand_Constants::NONE);
  in.has_command = 1;
  in.command_term = 70'000;
  in.command_stamp_us = 1'234'567'888'123;
  const messages::msg::Imu out = to_message(in);
  EXPECT_EQ(out.stamp_ns(), 1'234'567'890'123'000);
  EXPECT_EQ(out.specific_force_frd()[2], -9.75);
  EXPECT_EQ(out.body_rates_frd()[1], -0.25);
  EXPECT_EQ(out.obeyed().state(), messages::msg::ObeyedCommand_Constants::OBEYED);
  EXPECT_EQ(out.obeyed().term(), 70'000U);
  EXPECT_EQ(out.obeyed().stamp_ns(), 1'234'567'888'123'000);
  EXPECT_EQ(out.lockstep().mocap_pose(), 0U) << "always so in real time";
}

TEST(Wire, ACommandNamesTheSampleThatItAnswersInItsOwnMicroseconds) {
  plant::ActuatorCommand in;
  in.stamp_ns = 1'234'567'890'123'000;
  in.term = 3;
  in.rotor_state = plant::RotorState::kRunning;
  in.rotor_count = 4;
  in.throttle = {0.0, 0.5, 1.0, 1.0 / 65535.0};
  const protocol::Command out = to_wire(in);
  EXPECT_EQ(out.stamp_us, 1'234'567'890'123);
  EXPECT_EQ(out.term, 3U);
  EXPECT_EQ(out.rotors_running, 1);
  EXPECT_EQ(out.rotor_count, 4);
  EXPECT_EQ(out.throttle_u16, (std::array<std::uint16_t, 8>{0, 32768, 65535, 1}));
  in.rotor_state = plant::RotorState::kOff;
  EXPECT_EQ(to_wire(in).rotors_running, 0);
}

// Any number may come over the wire. Evaluated by the compiler, which refuses an overflow.
static_assert(protocol::ns_of_us(-7) == -7000);
static_assert(protocol::ns_of_us(std::numeric_limits<std::int64_t>::max()) ==
              protocol::ns_of_us(std::numeric_limits<std::int64_t>::max() / 4));
static_assert(protocol::ns_of_us(std::numeric_limits<std::int64_t>::max()) -
                  protocol::ns_of_us(std::numeric_limits<std::int64_t>::min()) >
              0);

TEST(Wire, RotorSpeedsAndBatteryKeepTheirValues) {
  protocol::RotorSpeeds speeds;
  speeds.stamp_us = 5;
  speeds.rotor_count = 4;
  speeds.speeds = {1.0F, 2.0F, 3.0F, 4.0F};
  EXPECT_EQ(to_message(speeds).stamp_ns(), 5000);
  EXPECT_EQ(to_message(speeds).rotor_count(), 4);
  EXPECT_EQ(to_message(speeds).speeds(), (std::array<double, 8>{1, 2, 3, 4}));
  const messages::msg::Battery battery = to_message(protocol::Battery{6, 3.75F, 2.5F, 0.5F});
  EXPECT_EQ(battery.stamp_ns(), 6000);
  EXPECT_EQ(battery.voltage_v(), 3.75);
  EXPECT_EQ(battery.current_a(), 2.5);
  EXPECT_EQ(battery.state_of_charge(), 0.5);
}

}  // namespace swiftlet::services::wire_test

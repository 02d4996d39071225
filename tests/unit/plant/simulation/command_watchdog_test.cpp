#include "swiftlet/plant/simulation/command_watchdog.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::tests::command_watchdog_test {

using plant::ActuatorCommand;
using plant::CommandFault;
using plant::CommandWatchdog;
using plant::ControlLevel;
using plant::ControlLevels;
using plant::RotorState;

constexpr std::int64_t kTimeout = 200;

ActuatorCommand command(std::int64_t stamp_ns, double throttle = 0.5) {
  ActuatorCommand command;
  command.stamp_ns = stamp_ns;
  command.rotor_state = RotorState::kRunning;
  command.rotor_count = 4;
  for (std::size_t i = 0; i < 4; ++i) command.throttle[i] = throttle;
  return command;
}

TEST(CommandWatchdog, KeepsRotorsOffUntilTheFirstCommand) {
  const CommandWatchdog watchdog(4, kTimeout);
  EXPECT_EQ(watchdog.motor_command(0).state, RotorState::kOff);
  EXPECT_EQ(watchdog.motor_command(1'000'000).state, RotorState::kOff);
  EXPECT_FALSE(watchdog.expired(1'000'000));  // there was no command yet
}

TEST(CommandWatchdog, PassesValidCommandsOn) {
  CommandWatchdog watchdog(4, kTimeout);
  ActuatorCommand good = command(1000);
  good.throttle = {0.0, 1.0, 0.25, 0.75, 0.9, 0.9, 0.9, 0.9};
  EXPECT_EQ(watchdog.accept(good, 1000), CommandFault::kNone);
  EXPECT_EQ(watchdog.motor_command(1000).state, RotorState::kRunning);
  EXPECT_EQ(watchdog.motor_command(1000).throttle,
            (plant::PerRotor{0.0, 1.0, 0.25, 0.75, 0.0, 0.0, 0.0, 0.0}));
  good.rotor_state = RotorState::kOff;
  EXPECT_EQ(watchdog.accept(good, 1001), CommandFault::kNone);  // answers the same sample again
  EXPECT_EQ(watchdog.motor_command(1001).state, RotorState::kOff);
}

TEST(CommandWatchdog, StopsRotorsWhenCommandsStop) {
  CommandWatchdog watchdog(4, kTimeout);
  watchdog.accept(command(1000), 1100);
  EXPECT_FALSE(watchdog.expired(1200));
  EXPECT_EQ(watchdog.motor_command(1200).state, RotorState::kRunning);
  EXPECT_TRUE(watchdog.expired(1201));  // counted from the stamp of the sample, not from the arrival
  EXPECT_EQ(watchdog.motor_command(1201).state, RotorState::kOff);
  EXPECT_EQ(watchdog.motor_command(1201).throttle, plant::PerRotor{});
  EXPECT_EQ(watchdog.accept(command(1300), 1300), CommandFault::kNone);
  EXPECT_EQ(watchdog.motor_command(1300).state, RotorState::kRunning);
}

TEST(CommandWatchdog, ObeysNoOutdatedCommand) {
  CommandWatchdog watchdog(4, kTimeout, ControlLevel::kActuators, 100);
  watchdog.accept(command(1000), 1050);
  EXPECT_FALSE(watchdog.outdated(1100));
  EXPECT_EQ(watchdog.motor_command(1100).throttle[0], 0.5);
  EXPECT_TRUE(watchdog.outdated(1101));  // counted from the stamp of the sample
  EXPECT_EQ(watchdog.motor_command(1101).state, RotorState::kRunning);
  EXPECT_EQ(watchdog.motor_command(1101).throttle, plant::PerRotor{});
  EXPECT_EQ(watchdog.motor_command(1201).state, RotorState::kOff);
}

// GIVEN a controller that sends the same command again and again THEN it gets old all the same.
TEST(CommandWatchdog, RepeatedCommandsGetOld) {
  CommandWatchdog watchdog(4, kTimeout, ControlLevel::kActuators, 100);
  for (std::int64_t now = 1000; now <= 1200; now += 10) {
    EXPECT_EQ(watchdog.accept(command(1000), now), CommandFault::kNone);
    EXPECT_EQ(watchdog.motor_command(now).throttle[0], now <= 1100 ? 0.5 : 0.0);
  }
  EXPECT_EQ(watchdog.accept(command(1000), 1210), CommandFault::kStale);
  EXPECT_EQ(watchdog.motor_command(1210).state, RotorState::kOff);
}

TEST(CommandWatchdog, RotorsThatWereTurnedOffStayOff) {
  CommandWatchdog watchdog(4, kTimeout, ControlLevel::kActuators, 100);
  ActuatorCommand off = command(1000);
  off.rotor_state = RotorState::kOff;
  watchdog.accept(off, 1000);
  EXPECT_EQ(watchdog.motor_command(1150).state, RotorState::kOff);
}

TEST(CommandWatchdog, RefusesLowerTermsUntilTheTermTimesOut) {
  CommandWatchdog watchdog(4, kTimeout);
  const auto with_term = [](std::uint32_t term, std::int64_t stamp_ns) {
    ActuatorCommand sent = command(stamp_ns);
    sent.term = term;
    return sent;
  };
  EXPECT_EQ(watchdog.accept(with_term(5, 1000), 1000), CommandFault::kNone);
  EXPECT_EQ(watchdog.accept(with_term(4, 1100), 1100), CommandFault::kOvertaken);
  EXPECT_EQ(watchdog.accept(with_term(6, 1150), 1150), CommandFault::kNone);
  EXPECT_EQ(watchdog.accept(with_term(5, 1350), 1350), CommandFault::kOvertaken);
  EXPECT_EQ(watchdog.accept(with_term(0, 1351), 1351), CommandFault::kNone)
      << "the higher term has timed out";
}

TEST(CommandWatchdog, ReportsTheCommandInEffect) {
  CommandWatchdog watchdog(4, kTimeout);
  EXPECT_TRUE(watchdog.obeyed().reported);
  EXPECT_FALSE(watchdog.obeyed().any);
  ActuatorCommand sent = command(1000);
  sent.term = 7;
  watchdog.accept(sent, 1010);
  sent.term = 6;
  sent.stamp_ns = 1020;
  watchdog.accept(sent, 1020);
  EXPECT_TRUE(watchdog.obeyed().any);
  EXPECT_EQ(watchdog.obeyed().term, 7U);
  EXPECT_EQ(watchdog.obeyed().stamp_ns, 1000);
}

struct InvalidCommand {
  const char* name;
  CommandFault fault;
  ActuatorCommand command;
  std::string sentence;
};

std::vector<InvalidCommand> invalid_commands() {
  std::vector<InvalidCommand> all;
  const auto add = [&](const char* name, CommandFault fault, const ActuatorCommand& c, const char* sentence) {
    all.push_back({name, fault, c, sentence});
  };
  ActuatorCommand c = command(1000, 0.9);
  c.rotor_count = 6;
  add("too many rotors", CommandFault::kRotorCount, c, "rotor count differs from the vehicle's");
  c.rotor_count = 0;
  add("no rotors", CommandFault::kRotorCount, c, "rotor count differs from the vehicle's");
  c = command(1000, 0.9);
  c.rotor_state = static_cast<RotorState>(2);
  add("unknown state", CommandFault::kRotorState, c, "rotor state is neither off nor running");
  for (const double throttle : {std::numeric_limits<double>::quiet_NaN(), -1.0e-9, 1.0 + 1.0e-9,
                                std::numeric_limits<double>::infinity()}) {
    c = command(1000, 0.9);
    c.throttle[3] = throttle;
    add("bad throttle", CommandFault::kThrottle, c, "throttle is not a number within 0 .. 1");
    c.rotor_state = RotorState::kOff;
    add("bad throttle of rotors that are off", CommandFault::kThrottle, c,
        "throttle is not a number within 0 .. 1");
  }
  add("older than the last", CommandFault::kStale, command(899, 0.9), "answers an outdated IMU sample");
  add("from the future", CommandFault::kFuture, command(1051, 0.9), "answers an IMU sample of the future");
  return all;
}

TEST(CommandWatchdog, RefusesInvalidCommandsWithoutEffect) {
  for (const InvalidCommand& invalid : invalid_commands()) {
    SCOPED_TRACE(invalid.name);
    CommandWatchdog watchdog(4, kTimeout);
    ASSERT_EQ(watchdog.accept(command(900), 900), CommandFault::kNone);
    EXPECT_EQ(watchdog.accept(invalid.command, 1050), invalid.fault);
    EXPECT_EQ(plant::to_string(invalid.fault), invalid.sentence);
    EXPECT_EQ(watchdog.motor_command(1100).throttle[0], 0.5);
    EXPECT_EQ(watchdog.motor_command(1101).state, RotorState::kOff)
        << "the invalid command reset the timeout";
  }
}

plant::VehicleCommand at_level(ControlLevel level, const plant::CommandHeader& header) {
  plant::VehicleCommand sent = plant::rotors_off(level, header, 4);
  plant::header_of(sent).rotor_state = header.rotor_state;
  return sent;
}

// GIVEN a vehicle that accepts some levels THEN it obeys these alone, and "rotors off" at level actuators.
TEST(CommandWatchdog, AcceptsOnlyTheLevelsOfTheVehicle) {
  CommandWatchdog watchdog(4, kTimeout, ControlLevels::from_bits(0b1010));  // rates, trajectory
  const ActuatorCommand header = command(1000);
  EXPECT_EQ(watchdog.accept(at_level(ControlLevel::kActuators, header), 1000), CommandFault::kLevel);
  EXPECT_EQ(watchdog.accept(at_level(ControlLevel::kAttitude, header), 1000), CommandFault::kLevel);
  EXPECT_STREQ(plant::to_string(CommandFault::kLevel), "the vehicle does not accept commands at this level");
  EXPECT_EQ(watchdog.motor_command(1000).state, RotorState::kOff);
  EXPECT_EQ(watchdog.accept(at_level(ControlLevel::kRates, header), 1000), CommandFault::kNone);
  EXPECT_EQ(watchdog.motor_command(1000).state, RotorState::kRunning);
  EXPECT_EQ(watchdog.accept(plant::rotors_off(ControlLevel::kActuators, header, 4), 1001),
            CommandFault::kNone);
  EXPECT_EQ(watchdog.motor_command(1001).state, RotorState::kOff);
}

// GIVEN a controller that commands at one level WHEN one of a lower term commands at another THEN it is refused.
TEST(CommandWatchdog, TermsHoldAcrossLevels) {
  CommandWatchdog watchdog(4, kTimeout, ControlLevels::from_bits(0b1111));
  ActuatorCommand header = command(1000);
  header.term = 5;
  EXPECT_EQ(watchdog.accept(at_level(ControlLevel::kAttitude, header), 1000), CommandFault::kNone);
  header.term = 4;
  header.stamp_ns = 1100;
  for (const ControlLevel level : plant::kControlLevels)
    EXPECT_EQ(watchdog.accept(at_level(level, header), 1100), CommandFault::kOvertaken);
}

TEST(CommandWatchdog, RefusesSetpointsThatAreNotFinite) {
  CommandWatchdog watchdog(4, kTimeout, ControlLevels::from_bits(0b1111));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  plant::RatesSetpoint rates;
  rates.body_rates_frd.y() = nan;
  plant::RatesSetpoint pushing;
  pushing.thrust_n = -0.1;
  plant::AttitudeSetpoint attitude;
  attitude.thrust_n = nan;
  plant::TrajectorySetpoint trajectory;
  trajectory.acceleration_ned.z() = nan;
  for (const plant::VehicleCommand& invalid :
       std::vector<plant::VehicleCommand>{rates, pushing, attitude, trajectory})
    EXPECT_EQ(watchdog.accept(invalid, 0), CommandFault::kNotFinite);
  EXPECT_FALSE(watchdog.obeyed().any);
}

TEST(CommandWatchdog, RefusesCommandsOlderThanTheTimeout) {
  CommandWatchdog watchdog(4, kTimeout);
  EXPECT_EQ(watchdog.accept(command(999), 1200), CommandFault::kStale);
  EXPECT_EQ(watchdog.motor_command(1200).state, RotorState::kOff);
  EXPECT_EQ(watchdog.accept(command(1000), 1200), CommandFault::kNone);
}

}  // namespace swiftlet::tests::command_watchdog_test

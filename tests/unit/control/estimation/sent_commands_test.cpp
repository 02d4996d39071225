#include "swiftlet/control/estimation/sent_commands.hpp"

#include <gtest/gtest.h>

namespace swiftlet::control::sent_commands_test {

constexpr std::int64_t kPeriodNs = 2'000'000;
constexpr double kPeriod_s = 0.002;

plant::ObeyedCommand obeyed(std::int64_t stamp_ns) { return {true, true, 1, stamp_ns}; }

// The thrust of each command is the number of its sample.
void fly(SentCommands& commands, int count, int delay) {
  for (int i = 1; i <= count; ++i) {
    const bool any = i > delay;
    commands.sample(i * kPeriodNs, kPeriod_s,
                    any ? obeyed((i - delay) * kPeriodNs) : plant::ObeyedCommand{true, false, 0, 0});
    EXPECT_EQ(commands.obeyed_thrust_n(), any ? i - delay : 0.0) << i;
    commands.sent(i * kPeriodNs, i);
  }
}

TEST(SentCommands, GivesTheOneThatIsObeyedAndItsAge) {
  for (const int delay : {1, 5, 40}) {
    SentCommands commands;
    fly(commands, 600, delay);
    EXPECT_NEAR(commands.delay_s(), delay * kPeriod_s, 1e-9);
  }
}

TEST(SentCommands, WithoutAReportTheNewestIsObeyed) {
  SentCommands commands;
  commands.sample(kPeriodNs, kPeriod_s, {});
  EXPECT_EQ(commands.obeyed_thrust_n(), 0.0);
  commands.sent(kPeriodNs, 1.0);
  commands.sent(2 * kPeriodNs, 2.0);
  commands.sample(3 * kPeriodNs, kPeriod_s, {});
  EXPECT_EQ(commands.obeyed_thrust_n(), 2.0);
  EXPECT_EQ(commands.delay_s(), 0.0);
}

// GIVEN commands that are lost THEN the last one that arrived is obeyed, also for longer than commands are kept.
TEST(SentCommands, HoldsTheOneBeforeLostCommands) {
  SentCommands commands;
  fly(commands, 100, 1);
  for (int i = 101; i <= 200; ++i) {
    commands.sample(i * kPeriodNs, kPeriod_s, obeyed(99 * kPeriodNs));
    EXPECT_EQ(commands.obeyed_thrust_n(), 99.0);
    commands.sent(i * kPeriodNs, i);
  }
  EXPECT_GT(commands.delay_s(), 0.04);
  EXPECT_LE(commands.delay_s(), SentCommands::kLongestDelay_s);
  commands.sample(201 * kPeriodNs, kPeriod_s, obeyed(150 * kPeriodNs));
  EXPECT_EQ(commands.obeyed_thrust_n(), 150.0);
}

// GIVEN a report of a command of long ago, that of another controller THEN the delay counts as the longest, and no older command is used.
TEST(SentCommands, BoundsTheDelay) {
  SentCommands commands;
  commands.sent(1'000'000'000'000, 1.0);
  commands.sample(1'000'002'000'000, kPeriod_s, obeyed(5));
  EXPECT_EQ(commands.delay_s(), SentCommands::kLongestDelay_s);
  for (int i = 1; i <= 2000; ++i) commands.sent(1'000'000'000'000 + i * kPeriodNs, i);
  commands.sample(1'004'000'000'000, kPeriod_s, obeyed(1'003'998'000'000));
  EXPECT_EQ(commands.obeyed_thrust_n(), 1999.0);
}

}  // namespace swiftlet::control::sent_commands_test

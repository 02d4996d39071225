#include "swiftlet/plant/simulation/links/radio.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::tests::radio_test {

using plant::RadioLine;
using plant::RadioLink;
using plant::RadioSettings;
using plant::SimulationSettings;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::uint64_t kStream = plant::streams::kRadioTelemetry;

TEST(Radio, WithoutSettingsIsNone) {
  RadioLink link(RadioSettings{}, 1, kStream);
  EXPECT_FALSE(link.on());
  for (std::int64_t t = 0; t < 100; ++t) EXPECT_EQ(link.send(t), 0);
}

TEST(Radio, DelaysWithinTheJitterAndLosesItsShare) {
  const RadioSettings settings{0.01, 0.004, 0.02};
  RadioLink link(settings, 1, kStream);
  constexpr int kPackets = 20'000;
  int lost = 0;
  std::int64_t least_ns = 1'000'000'000;
  std::int64_t most_ns = 0;
  for (int i = 1; i <= kPackets; ++i) {
    const auto takes_ns = link.send(i);
    if (!takes_ns) {
      ++lost;
      continue;
    }
    least_ns = std::min(least_ns, *takes_ns);
    most_ns = std::max(most_ns, *takes_ns);
  }
  EXPECT_NEAR(lost, 400, 80);  // four standard deviations
  EXPECT_GE(least_ns, 10 * kMillisecond);
  EXPECT_LE(most_ns, 14 * kMillisecond);
  EXPECT_LT(least_ns, 10.1 * kMillisecond);
  EXPECT_GT(most_ns, 13.9 * kMillisecond);
}

TEST(Radio, DrawsTheSameForASeed) {
  const RadioSettings settings{0.01, 0.004, 0.1};
  RadioLink one(settings, 7, kStream);
  RadioLink same(settings, 7, kStream);
  RadioLink other(settings, 8, kStream);
  int different = 0;
  for (int i = 1; i <= 100; ++i) {
    const auto takes_ns = one.send(i);
    EXPECT_EQ(takes_ns, same.send(i));
    if (takes_ns != other.send(i)) ++different;
  }
  EXPECT_GT(different, 90);
}

TEST(Radio, TheFirstPacketEstablishesTheLink) {
  RadioLink link({0.02, 0.0, 0.9}, 1, kStream);
  EXPECT_EQ(link.send(0), 0);
}

TEST(Radio, PacketsKeepTheirOrder) {
  SimulationSettings settings;
  settings.radio = {0.005, 0.02, 0.0};
  RadioLine<int> line(settings, 1, kStream);
  std::vector<int> arrived;
  for (int i = 0; i < 200; ++i) {
    const std::int64_t now_ns = i * 2 * kMillisecond;
    line.send(i, now_ns);
    while (const auto* packet = line.take(now_ns)) arrived.push_back(*packet);
  }
  ASSERT_GT(arrived.size(), 180U);
  for (std::size_t i = 0; i < arrived.size(); ++i) EXPECT_EQ(arrived[i], static_cast<int>(i));
}

// GIVEN a radio and a fault that delays commands THEN both add up.
TEST(Radio, DelaysCommandsBeforeFaultsDo) {
  SimulationSettings settings;
  settings.radio = {0.01, 0.0, 0.0};
  plant::Fault late;
  late.kind = plant::FaultKind::kCommandsDelay;
  late.at_s = 0.1;
  late.for_s = 0.1;
  late.delay_s = 0.005;
  settings.faults = {late};
  plant::CommandPath path(settings, 1);
  plant::ActuatorCommand command;
  command.stamp_ns = 50 * kMillisecond;
  EXPECT_FALSE(path.send(command, command.stamp_ns));
  EXPECT_FALSE(path.arrived(59 * kMillisecond).has_value());
  EXPECT_TRUE(path.arrived(60 * kMillisecond).has_value());
  command.stamp_ns = 150 * kMillisecond;
  EXPECT_FALSE(path.send(command, command.stamp_ns));
  EXPECT_FALSE(path.arrived(164 * kMillisecond).has_value());
  EXPECT_TRUE(path.arrived(165 * kMillisecond).has_value());
}

}  // namespace swiftlet::tests::radio_test

#include "swiftlet/plant/model/telemetry_rate.hpp"

#include <cstdint>
#include <initializer_list>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::plant::telemetry_rate_test {

// Telemetry samples in the second that begins at a sequence number.
int telemetry_samples(std::uint64_t rate_hz, std::uint64_t from) {
  int count = 0;
  for (std::uint64_t sequence = from; sequence < from + rate_hz; ++sequence)
    count += is_telemetry_sample(sequence, static_cast<std::int64_t>(1'000'000'000 / rate_hz)) ? 1 : 0;
  return count;
}

TEST(TelemetryRate, IsOneHundredSamplesPerSecond) {
  for (const std::uint64_t rate_hz : {100U, 200U, 500U, 1000U}) {
    EXPECT_EQ(telemetry_samples(rate_hz, 1), 100) << rate_hz;
    EXPECT_EQ(telemetry_samples(rate_hz, 4711), 100) << rate_hz;
  }
  EXPECT_EQ(telemetry_samples(400, 1), 100) << "2.5 ms";
  EXPECT_EQ(telemetry_samples(50, 1), 50) << "all samples of a slower stream";
}

TEST(TelemetryRate, SelectsMultiplesOfTheDecimation) {
  for (std::uint64_t sequence = 1; sequence <= 20; ++sequence)
    EXPECT_EQ(is_telemetry_sample(sequence, 2'000'000), sequence % 5 == 0) << sequence;
}

TEST(TelemetryRate, SelectsTheFirstSampleAfterAMissedOne) {
  const auto selected = [](std::initializer_list<std::uint64_t> received) {
    std::vector<std::uint64_t> list;
    std::uint64_t last = 0;
    for (const std::uint64_t sequence : received) {
      if (is_telemetry_sample(sequence, last, 2'000'000)) list.push_back(sequence);
      last = sequence;
    }
    return list;
  };
  using List = std::vector<std::uint64_t>;
  EXPECT_EQ(selected({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), (List{5, 10})) << "without losses";
  EXPECT_EQ(selected({1, 4, 6, 7, 9, 12, 13, 15, 23}), (List{6, 12, 15, 23}));
  EXPECT_EQ(selected({5, 5, 5}), (List{5, 5, 5})) << "a sample that lockstep repeats";
}

TEST(TelemetryRate, SelectsAllSamplesOfAnUnknownPeriod) {
  EXPECT_TRUE(is_telemetry_sample(1, 0));
  EXPECT_TRUE(is_telemetry_sample(7, 0));
}

}  // namespace swiftlet::plant::telemetry_rate_test

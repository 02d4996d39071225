#include "swiftlet/recording/telemetry_rate.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace swiftlet::runtime {
namespace {

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

TEST(TelemetryRate, SelectsAllSamplesOfAnUnknownPeriod) {
  EXPECT_TRUE(is_telemetry_sample(1, 0));
  EXPECT_TRUE(is_telemetry_sample(7, 0));
}

}  // namespace
}  // namespace swiftlet::runtime

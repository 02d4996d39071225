// Measured rotor speeds correct the model with one bandwidth at any sample rate.
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/control/estimation/rotor_observer.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::rotor_bandwidth_test {

constexpr double kBandwidth = 112.0;  // rad/s
constexpr std::int64_t kStart_ns = 1'000'000'000;

plant::RotorSpeedSample measured(std::int64_t stamp_ns, double speed) {
  plant::RotorSpeedSample sample;
  sample.stamp_ns = stamp_ns;
  sample.rotor_count = 4;
  for (std::size_t i = 0; i < 4; ++i) sample.speeds[i] = speed;
  return sample;
}

class RotorBandwidth : public testing::TestWithParam<std::int64_t> {};

TEST_P(RotorBandwidth, DifferenceDecaysEquallyAtEveryRate) {
  RotorObserver observer(tests::kaylion(), kBandwidth);
  observer.correct(measured(kStart_ns, 1000.0));
  EXPECT_EQ(observer.speeds()[0], 1000.0) << "the first measurement is taken as it is";
  for (std::int64_t t = GetParam(); t <= 20'000'000; t += GetParam())
    observer.correct(measured(kStart_ns + t, 1500.0));
  EXPECT_NEAR(observer.speeds()[3], 1500.0 - 500.0 * std::exp(-kBandwidth * 0.02), 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Periods, RotorBandwidth,
                         testing::Values(1'000'000, 2'000'000, 10'000'000, 20'000'000));

TEST(RotorObserverStamps, IgnoresRepeatedAndLateSamples) {
  RotorObserver observer(tests::kaylion(), kBandwidth);
  observer.correct(measured(kStart_ns, 1000.0));
  observer.correct(measured(kStart_ns + 2'000'000, 1500.0));
  const plant::PerRotor speeds = observer.speeds();
  observer.correct(measured(kStart_ns + 2'000'000, 1500.0));
  observer.correct(measured(kStart_ns + 1'000'000, 0.0));
  EXPECT_EQ(observer.speeds(), speeds);
}

}  // namespace swiftlet::control::rotor_bandwidth_test

#include "swiftlet/services/clocks/clock_filter.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::clocks::clock_filter_test {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kS = 1'000'000'000;
constexpr std::int64_t kPeriodNs = 250 * kMs;
constexpr std::int64_t kStartNs = 10 * kS;

// Two clocks, and a network between them with a fixed delay and queues.
class Network {
 public:
  explicit Network(unsigned seed) : random_(seed) {}

  std::int64_t offset_at(std::int64_t own_ns) const {
    return offset_ns + std::llround(drift * static_cast<double>(own_ns - kStartNs));
  }
  ClockExchange exchange(std::int64_t own_ns) {
    ClockExchange result;
    result.asked_ns = own_ns;
    const std::int64_t there_ns = own_ns + 100'000 + queue_ns(queue_there_ns);
    result.received_ns = there_ns + offset_at(there_ns);
    const std::int64_t answered_ns = there_ns + 20'000;
    result.answered_ns = answered_ns + offset_at(answered_ns);
    result.arrived_ns = answered_ns + 100'000 + queue_ns(queue_back_ns);
    return result;
  }
  bool is_lost(double share) { return std::uniform_real_distribution<>(0.0, 1.0)(random_) < share; }

  std::int64_t offset_ns = 0;
  double drift = 0.0;
  double queue_there_ns = 0.0;  // mean
  double queue_back_ns = 0.0;

 private:
  std::int64_t queue_ns(double mean_ns) {
    const double queue = std::exponential_distribution<>(1.0)(random_);
    return std::llround(mean_ns * queue);
  }

  std::mt19937 random_;
};

class ClockFilterTest : public testing::TestWithParam<unsigned> {
 protected:
  // Exchanges every 250 ms; returns the time of the next.
  std::int64_t run(std::int64_t from_ns, int exchanges) {
    for (int i = 0; i < exchanges; ++i, from_ns += kPeriodNs)
      EXPECT_EQ(filter_.add(network_.exchange(from_ns)), nullptr);
    return from_ns;
  }
  double error_ns(std::int64_t own_ns) const {
    return std::abs(static_cast<double>(filter_.estimate()->offset_at(own_ns) - network_.offset_at(own_ns)));
  }

  Network network_{GetParam()};
  ClockFilter filter_;
};

INSTANTIATE_TEST_SUITE_P(Seeds, ClockFilterTest, testing::Range(1U, 21U));

TEST_P(ClockFilterTest, KnowsTheOffsetAfterOneExchange) {
  network_.offset_ns = -3 * kS;
  network_.queue_there_ns = network_.queue_back_ns = 2e6;
  EXPECT_FALSE(filter_.estimate());
  run(kStartNs, 1);
  EXPECT_LE(error_ns(kStartNs), filter_.estimate()->uncertainty_ns(kStartNs));
}

TEST_P(ClockFilterTest, FindsOffsetAndDrift) {
  network_.offset_ns = 3 * kS;
  network_.drift = 50e-6;
  network_.queue_there_ns = network_.queue_back_ns = 1e6;
  const std::int64_t end_ns = run(kStartNs, 120);
  EXPECT_NEAR(filter_.estimate()->drift, 50e-6, 10e-6);
  EXPECT_LE(std::abs(filter_.estimate()->drift - 50e-6), 4.0 * filter_.estimate()->drift_deviation);
  EXPECT_LE(error_ns(end_ns), filter_.estimate()->uncertainty_ns(end_ns));
  EXPECT_LE(error_ns(end_ns), 150e3);
  EXPECT_EQ(filter_.steps(), 0);
}

// Queues of one direction: the mean of the offsets is wrong by half of the mean queue.
TEST_P(ClockFilterTest, TrustsTheShortestRoundTripsWhereOneDirectionQueues) {
  network_.offset_ns = kS;
  network_.queue_there_ns = 10e6;
  double sum_ns = 0.0;
  constexpr int kExchanges = 200;
  std::int64_t at_ns = kStartNs;
  for (int i = 0; i < kExchanges; ++i, at_ns += kPeriodNs) {
    const ClockExchange exchange = network_.exchange(at_ns);
    sum_ns += static_cast<double>(clocks::offset_ns(exchange) - kS);
    ASSERT_EQ(filter_.add(exchange), nullptr);
  }
  EXPECT_LT(error_ns(at_ns), 0.2 * sum_ns / kExchanges);
  EXPECT_LE(error_ns(at_ns), filter_.estimate()->uncertainty_ns(at_ns));
  EXPECT_EQ(filter_.steps(), 0);
}

TEST_P(ClockFilterTest, KnowsAStepAfterThreeExchanges) {
  network_.offset_ns = 3 * kS;
  network_.drift = 50e-6;
  network_.queue_there_ns = network_.queue_back_ns = 2e6;
  std::int64_t at_ns = run(kStartNs, 60);
  const std::int64_t before_ns = filter_.estimate()->offset_at(at_ns);
  network_.offset_ns += GetParam() % 2 == 0 ? kS : -kS;
  at_ns = run(at_ns, 2);
  EXPECT_EQ(filter_.steps(), 0);
  EXPECT_NEAR(static_cast<double>(filter_.estimate()->offset_at(at_ns) - before_ns), 0.0, 1e6);
  at_ns = run(at_ns, 1);
  EXPECT_EQ(filter_.steps(), 1);
  EXPECT_LE(error_ns(at_ns), filter_.estimate()->uncertainty_ns(at_ns));
  run(at_ns, 60);
  EXPECT_EQ(filter_.steps(), 1);
}

// Both stamps that this side takes of an exchange move.
TEST_P(ClockFilterTest, KnowsAStepOfTheOwnClockAfterThreeExchanges) {
  network_.offset_ns = 3 * kS;
  network_.drift = 50e-6;
  network_.queue_there_ns = network_.queue_back_ns = 2e6;
  std::int64_t at_ns = run(kStartNs, 60);
  const std::int64_t step_ns = GetParam() % 2 == 0 ? kS : -kS;
  const auto run_shifted = [&](int exchanges) {
    for (int i = 0; i < exchanges; ++i, at_ns += kPeriodNs) {
      ClockExchange exchange = network_.exchange(at_ns);
      exchange.asked_ns += step_ns;
      exchange.arrived_ns += step_ns;
      EXPECT_EQ(filter_.add(exchange), nullptr);
    }
  };
  run_shifted(2);
  EXPECT_EQ(filter_.steps(), 0);
  EXPECT_TRUE(filter_.is_in_doubt());
  run_shifted(1);
  EXPECT_EQ(filter_.steps(), 1);
  EXPECT_FALSE(filter_.is_in_doubt());
  run_shifted(60);
  EXPECT_EQ(filter_.steps(), 1);
  const std::int64_t expected_ns = network_.offset_at(at_ns) - step_ns;
  EXPECT_LE(std::abs(static_cast<double>(filter_.estimate()->offset_at(at_ns + step_ns) - expected_ns)),
            filter_.estimate()->uncertainty_ns(at_ns + step_ns));
}

TEST_P(ClockFilterTest, IgnoresSingleWrongExchanges) {
  network_.offset_ns = 3 * kS;
  network_.queue_there_ns = network_.queue_back_ns = 1e6;
  std::int64_t at_ns = kStartNs;
  for (int i = 0; i < 100; ++i, at_ns += kPeriodNs) {
    ClockExchange exchange = network_.exchange(at_ns);
    const std::int64_t wrong_ns = i > 0 && i % 3 == 0 ? i * 10 * kMs : 0;
    exchange.received_ns += wrong_ns;
    exchange.answered_ns += wrong_ns;
    ASSERT_EQ(filter_.add(exchange), nullptr);
  }
  EXPECT_EQ(filter_.steps(), 0);
  EXPECT_LE(error_ns(at_ns), filter_.estimate()->uncertainty_ns(at_ns));
}

TEST_P(ClockFilterTest, GrowsMoreUncertainWhileExchangesAreLost) {
  network_.offset_ns = 3 * kS;
  network_.drift = -80e-6;
  network_.queue_there_ns = network_.queue_back_ns = 1e6;
  std::int64_t at_ns = run(kStartNs, 8);
  for (int i = 0; i < 100; ++i, at_ns += kPeriodNs) {
    if (!network_.is_lost(0.7)) run(at_ns, 1);
    EXPECT_LE(error_ns(at_ns), filter_.estimate()->uncertainty_ns(at_ns)) << i;
  }
  const ClockEstimate& last = *filter_.estimate();
  EXPECT_GT(last.uncertainty_ns(at_ns + kS), last.uncertainty_ns(at_ns));
  EXPECT_GT(last.uncertainty_ns(at_ns + 100 * kS), last.uncertainty_ns(at_ns) + 150e3);
  EXPECT_LE(error_ns(at_ns + 100 * kS), last.uncertainty_ns(at_ns + 100 * kS));
  EXPECT_EQ(filter_.steps(), 0);
}

TEST(ClockExchange, HasTheOffsetAndRoundTripOfNtp) {
  const ClockExchange exchange{1000, 5300, 5400, 1500};
  EXPECT_EQ(fault_of(exchange), nullptr);
  EXPECT_EQ(round_trip_ns(exchange), 400);
  EXPECT_EQ(offset_ns(exchange), 4100);
  EXPECT_EQ(measured_ns(exchange), 1250);
}

TEST(ClockExchange, RefusesImpossibleStamps) {
  const auto fault = [](const ClockExchange& exchange) {
    const char* const text = fault_of(exchange);
    return std::string(text == nullptr ? "" : text);
  };
  EXPECT_EQ(fault({1000, 5400, 5300, 1500}), "it was answered before it was received");
  EXPECT_EQ(fault({1500, 5300, 5400, 1000}), "the answer arrived before the question was sent");
  EXPECT_EQ(fault({1000, 5300, 5900, 1500}), "the round trip is negative");
  EXPECT_EQ(fault({1000, 5300, 5300, 1001 + kS}), "the round trip took over 1 s");
  EXPECT_EQ(fault({1000, 5300, 5301 + kS, 2000 + kS}), "the answer took over 1 s");
  EXPECT_EQ(fault({1000, INT64_MAX, INT64_MAX, 1500}), "a stamp is out of range");
  EXPECT_EQ(fault({1000, INT64_MIN, 5300, 1500}), "a stamp is out of range");
  EXPECT_EQ(fault({0, (INT64_MAX >> 1), (INT64_MAX >> 1), 1}), "") << "the largest stamp";
}

TEST(ClockFilter, RefusesAnExchangeThatIsNotNewer) {
  ClockFilter filter;
  EXPECT_EQ(filter.add({2000, 5300, 5400, 2500}), nullptr);
  EXPECT_STREQ(filter.add({2000, 5300, 5400, 2500}), "a later question was answered before");
  EXPECT_STREQ(filter.add({1000, 5300, 5400, 1500}), "a later question was answered before");
  EXPECT_EQ(filter.estimate()->measured_ns, 2250);
}

}  // namespace swiftlet::clocks::clock_filter_test

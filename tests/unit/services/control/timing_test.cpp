// Timing figures of the services.
#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/services/control/step_timing.hpp"
#include "swiftlet/services/plant/answer_latencies.hpp"

namespace swiftlet::services::timing_test {

constexpr std::int64_t kPeriod = 2'000'000;  // ns

// Samples at 500 Hz with a given delay of arrival.
class Arrivals {
 public:
  explicit Arrivals(StepTiming& timing) : timing_(timing) {}
  void arrive(std::int64_t delay_ns = 0, bool rotors_running = true) {
    ++sequence_;
    const std::int64_t stamp = static_cast<std::int64_t>(sequence_) * kPeriod;
    timing_.arrived(sequence_, stamp, 1'000'000'000 + stamp + delay_ns, rotors_running);
    timing_.answered(1'000'000'000 + stamp + delay_ns + 50'000);
  }
  void skip(std::uint64_t samples) { sequence_ += samples; }

 private:
  StepTiming& timing_;
  std::uint64_t sequence_ = 0;
};

TEST(StepTiming, CountsStepsSinceTheRotorsWereStarted) {
  StepTiming timing;
  Arrivals samples(timing);
  for (int i = 0; i < 10; ++i) samples.arrive(0, false);
  EXPECT_EQ(timing.figures().cycles, 0U);
  EXPECT_EQ(timing.period_ns(), kPeriod);
  for (int i = 0; i < 101; ++i) samples.arrive();
  EXPECT_EQ(timing.figures().cycles, 101U);
  EXPECT_NEAR(timing.figures().rate_hz, 500.0, 1e-9);
  EXPECT_EQ(timing.figures().longest_ns, 50'000);
  EXPECT_EQ(timing.figures().deadline_misses, 0U);

  for (int i = 0; i < 10; ++i) samples.arrive(0, false);
  EXPECT_EQ(timing.figures().cycles, 101U);  // kept until the rotors start again
  samples.arrive();
  EXPECT_EQ(timing.figures().cycles, 1U);
}

TEST(StepTiming, MeasuresJitterOfTheTimeBetweenSteps) {
  StepTiming timing;
  Arrivals samples(timing);
  for (std::uint64_t i = 0; i < 2 * StepTiming::kJitterUpdate; ++i) samples.arrive(i % 2 == 0 ? 0 : 30'000);
  EXPECT_NEAR(static_cast<double>(timing.figures().jitter_p50_ns), 30'000.0, 1'000.0);
  EXPECT_NEAR(static_cast<double>(timing.figures().jitter_p99_ns), 30'000.0, 1'000.0);
  samples.skip(3);
  samples.arrive(30'000 + 200'000);
  EXPECT_EQ(timing.figures().jitter_max_ns, 200'000) << "lost samples do not count as jitter";
}

TEST(StepTiming, CountsStepsLaterThanHalfAPeriod) {
  StepTiming timing;
  Arrivals samples(timing);
  for (int i = 0; i < 100; ++i) samples.arrive();
  samples.arrive(kPeriod / 2 - 100'000);
  EXPECT_EQ(timing.figures().deadline_misses, 0U);
  for (int i = 0; i < 100; ++i) samples.arrive();
  samples.arrive(kPeriod / 2 + 100'000);
  EXPECT_EQ(timing.figures().deadline_misses, 1U);
  samples.arrive();
  EXPECT_EQ(timing.figures().deadline_misses, 1U);
}

TEST(StepTiming, AdaptsToALastingDelay) {
  StepTiming timing;
  Arrivals samples(timing);
  for (int i = 0; i < 100; ++i) samples.arrive();
  for (int i = 0; i < 100; ++i) samples.arrive(2 * kPeriod);
  EXPECT_GE(timing.figures().deadline_misses, 1U);
  EXPECT_LE(timing.figures().deadline_misses, 12U);
}

TEST(StepTiming, DoesNotCountLostSamplesAsLate) {
  StepTiming timing;
  Arrivals samples(timing);
  for (int i = 0; i < 10; ++i) samples.arrive();
  samples.skip(5);
  samples.arrive();
  EXPECT_EQ(timing.figures().deadline_misses, 0U);
  EXPECT_EQ(timing.period_ns(), kPeriod);
  EXPECT_NEAR(timing.figures().rate_hz, 500.0 * 10.0 / 15.0, 1e-9);  // rate of steps, not of samples sent
}

TEST(StepTiming, DoesNotCountAClockResetAsLate) {
  StepTiming timing;
  timing.arrived(100, 100 * kPeriod, 1'000'000, true);
  timing.arrived(101, 101 * kPeriod, 1'000'000 + kPeriod, true);
  timing.arrived(1, kPeriod, 900'000'000, true);
  timing.arrived(2, 2 * kPeriod, 900'000'000 + kPeriod, true);
  EXPECT_EQ(timing.figures().deadline_misses, 0U);
}

TEST(AnswerLatencies, RunFromASampleToItsFirstAnswer) {
  AnswerLatencies times(kPeriod);
  times.written(1, 1000);
  times.answered(1, 1500);
  times.answered(1, 9000);  // repeated
  times.answered(7, 9000);  // never written
  EXPECT_EQ(times.times().count(), 1U);
  EXPECT_EQ(times.times().max_ns(), 500);
  EXPECT_EQ(times.unanswered(), 0U);
}

TEST(AnswerLatencies, CountAnswersLaterThanAPeriod) {
  AnswerLatencies times(kPeriod);
  times.written(1, 0);
  times.answered(1, kPeriod);
  EXPECT_EQ(times.late(), 0U);
  times.written(2, 0);
  times.answered(2, kPeriod + 1);
  EXPECT_EQ(times.late(), 1U);
  times.reset();
  EXPECT_EQ(times.late(), 0U);
}

TEST(AnswerLatencies, CountUnansweredSamplesAfterThePatience) {
  AnswerLatencies times(kPeriod);
  for (std::uint64_t sequence = 1; sequence <= AnswerLatencies::kPatience; ++sequence)
    times.written(sequence, 0);
  EXPECT_EQ(times.unanswered(), 0U);
  times.answered(2, 10);
  times.written(AnswerLatencies::kPatience + 1, 0);  // gives up on 1
  times.written(AnswerLatencies::kPatience + 2, 0);  // 2 was answered
  EXPECT_EQ(times.unanswered(), 1U);
  times.answered(1, 20);  // too late
  EXPECT_EQ(times.times().count(), 1U);
}

}  // namespace swiftlet::services::timing_test

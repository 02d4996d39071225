#include "swiftlet/recording/tracking.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace swiftlet::ground::tracking_test {

constexpr std::int64_t kStep = 2'000'000;  // ns

// A flight of `count` samples whose truth is the reference plus error(i). keep_truth and keep_reference
// select the rows to record.
struct SyntheticFlight {
  Track<TruthRow> truth{2000};
  Track<ReferenceRow> reference{2000};

  using Keep = std::function<bool(int)>;
  using Error = std::function<std::array<double, 3>(int)>;
  SyntheticFlight(
      int count, const Error& error, const Keep& keep_truth = [](int) { return true; },
      const Keep& keep_reference = [](int) { return true; }) {
    for (int i = 0; i < count; ++i) {
      const std::array<double, 3> at = {0.01 * i, std::sin(0.01 * i), -1.0};
      const double period_s = 1e-9 * kStep;
      const auto e = error(i);
      TruthRow flown;
      flown.stamp_ns = i * kStep;
      flown.position_ned = {at[0] + e[0], at[1] + e[1], at[2] + e[2]};
      flown.velocity_ned = {0.01 / period_s, 0.01 * std::cos(0.01 * i) / period_s, 0.0};
      ReferenceRow reference_row;
      reference_row.stamp_ns = i * kStep;
      reference_row.position_ned = at;
      if (keep_truth(i)) truth.append(flown);
      if (keep_reference(i)) reference.append(reference_row);
    }
  }
};

TEST(TrackingErrors, EqualAConstantError) {
  const SyntheticFlight flight(1000, [](int) { return std::array<double, 3>{0.003, -0.004, 0.012}; });
  const TrackingErrors errors = tracking_errors(flight.truth, flight.reference, {0, 1000 * kStep});
  EXPECT_EQ(errors.matched, 1000U);
  EXPECT_NEAR(errors.rms_m[0], 0.003, 1e-12);
  EXPECT_NEAR(errors.rms_m[1], 0.004, 1e-12);
  EXPECT_NEAR(errors.rms_m[2], 0.012, 1e-12);
  EXPECT_NEAR(errors.peak_m[1], 0.004, 1e-12);
  EXPECT_NEAR(errors.rms_3d_m, 0.013, 1e-12);
  EXPECT_NEAR(errors.peak_3d_m, 0.013, 1e-12);
}

TEST(TrackingErrors, OfASineHaveAnRmsOfAmplitudeOverRootTwo) {
  const SyntheticFlight flight(1000, [](int i) {
    return std::array<double, 3>{0.02 * std::sin(2 * M_PI * i / 100.0), 0.0, 0.0};
  });
  const TrackingErrors errors = tracking_errors(flight.truth, flight.reference, {0, 1000 * kStep});
  EXPECT_NEAR(errors.rms_m[0], 0.02 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(errors.peak_m[0], 0.02, 1e-9);
  EXPECT_NEAR(errors.rms_3d_m, errors.rms_m[0], 1e-12);
}

TEST(TrackingErrors, TakeThePeakOfOneInstantNotOfEachAxis) {
  const SyntheticFlight flight(100, [](int i) {
    return std::array<double, 3>{i == 10 ? 0.03 : 0.0, i == 20 ? 0.04 : 0.0, 0.0};
  });
  const TrackingErrors errors = tracking_errors(flight.truth, flight.reference, {0, 100 * kStep});
  EXPECT_NEAR(errors.peak_3d_m, 0.04, 1e-12);
}

TEST(TrackingErrors, CountSamplesInTheWindowOnly) {
  const SyntheticFlight flight(1000, [](int i) {
    return std::array<double, 3>{i < 100 || i >= 900 ? 1.0 : 0.001, 0.0, 0.0};
  });
  const TrackingErrors errors = tracking_errors(flight.truth, flight.reference, {100 * kStep, 900 * kStep});
  EXPECT_EQ(errors.matched, 800U);
  EXPECT_NEAR(errors.peak_3d_m, 0.001, 1e-12);
}

TEST(TrackingErrors, InterpolateTheTruthWhereItsRowIsMissing) {
  const SyntheticFlight flight(
      1000,
      [](int) {
        return std::array<double, 3>{0.001, 0.0, 0.0};
      },
      [](int i) { return i % 3 != 0; }, [](int i) { return i % 5 != 0; });
  const TrackingErrors errors =
      tracking_errors(flight.truth, flight.reference, {0, 1000 * kStep}, TruthSource::kInterpolated);
  EXPECT_EQ(errors.matched, 799U) << "of 800 references, the last is beyond the truth or the first before it";
  EXPECT_NEAR(errors.peak_3d_m, 0.001, 1e-9) << "the truth of the path is a cubic to within 1 nm";
}

TEST(TrackingErrors, CompareSamplesOfEqualStampsOnlyUnlessTold) {
  const SyntheticFlight flight(
      1000, [](int) { return std::array<double, 3>{}; }, [](int i) { return i % 3 != 0; },
      [](int i) { return i % 5 != 0; });
  EXPECT_EQ(tracking_errors(flight.truth, flight.reference, {0, 1000 * kStep}).matched, 533U);
}

TEST(TrackingErrors, CountARepeatedReferenceOnce) {
  SyntheticFlight flight(100, [](int) { return std::array<double, 3>{}; });
  Track<ReferenceRow> repeated(200);
  for (const ReferenceRow& row : flight.reference) {
    repeated.append(row);
    repeated.append(row);
  }
  EXPECT_EQ(tracking_errors(flight.truth, repeated, {0, 100 * kStep}).matched, 100U);
}

TEST(TrackingErrors, DoNotInterpolateOverLongGaps) {
  const auto none = [](int) { return std::array<double, 3>{}; };
  const auto matched = [&](int missing) {
    const SyntheticFlight flight(100, none, [=](int i) { return i < 50 || i >= 50 + missing; });
    return tracking_errors(flight.truth, flight.reference, {0, 100 * kStep}, TruthSource::kInterpolated)
        .matched;
  };
  EXPECT_EQ(matched(24), 100U) << "50 ms between the rows";
  EXPECT_EQ(matched(25), 75U) << "52 ms between the rows";
}

TEST(NewestError, IsThatOfTheLastReferenceWhoseTruthIsKnown) {
  const auto error = [](int i) { return std::array<double, 3>{0.001 * i, 0.0, 0.0}; };
  const SyntheticFlight equal(100, error);
  EXPECT_NEAR(newest_error_m(equal.truth, equal.reference), 0.099, 1e-9);
  const SyntheticFlight between(
      100,
      [](int) {
        return std::array<double, 3>{0.002, 0.0, 0.0};
      },
      [](int i) { return i % 4 == 0; }, [](int i) { return i % 4 == 2; });
  EXPECT_NEAR(newest_error_m(between.truth, between.reference), 0.002, 1e-6);
  const SyntheticFlight ended(100, error, [](int i) { return i < 20; });
  EXPECT_TRUE(std::isnan(newest_error_m(ended.truth, ended.reference))) << "the truth is too old";
  EXPECT_TRUE(std::isnan(newest_error_m(Track<TruthRow>(1), equal.reference)));
}

TEST(TruthAt, InterpolatesAllOfARow) {
  Track<TruthRow> truth(2);
  TruthRow row;
  row.q_ned_from_frd = {1.0, 0.0, 0.0, 0.0};
  row.rotor_speeds = {100.0};
  row.supply_voltage_v = 4.0;
  truth.append(row);
  row.stamp_ns = 10'000'000;
  row.velocity_ned = {0.0, 0.0, 0.2};
  row.q_ned_from_frd = {-std::cos(0.1), 0.0, 0.0,
                        -std::sin(0.1)};  // the turn by 0.2 rad, with the other sign
  row.rotor_speeds = {200.0};
  row.supply_voltage_v = 3.8;
  truth.append(row);
  const auto at = truth_at(truth, truth.begin() + 1, 5'000'000, TruthSource::kInterpolated);
  ASSERT_TRUE(at);
  EXPECT_EQ(at->stamp_ns, 5'000'000);
  EXPECT_NEAR(at->velocity_ned[2], 0.1, 1e-12);
  EXPECT_NEAR(at->q_ned_from_frd[0], std::cos(0.05), 1e-12);
  EXPECT_NEAR(at->q_ned_from_frd[3], std::sin(0.05), 1e-12);
  EXPECT_NEAR(at->rotor_speeds[0], 150.0, 1e-12);
  EXPECT_NEAR(at->supply_voltage_v, 3.9, 1e-12);
  EXPECT_FALSE(truth_at(truth, truth.begin() + 1, 5'000'000, TruthSource::kEqualStamps));
}

TEST(TrackingErrors, AreNaNWithoutAMatch) {
  const SyntheticFlight flight(
      100, [](int) { return std::array<double, 3>{}; }, [](int i) { return i % 20 == 0; },
      [](int i) { return i % 20 == 10; });
  const TrackingErrors errors = tracking_errors(flight.truth, flight.reference, {0, 100 * kStep});
  EXPECT_EQ(errors.matched, 0U);
  EXPECT_TRUE(std::isnan(errors.rms_3d_m));
  EXPECT_TRUE(std::isnan(errors.peak_3d_m));
  EXPECT_FALSE(enough_samples(errors, {0, 100 * kStep}, 500.0));
}

TEST(TrackingErrors, AreNaNIfTheTruthIsNaN) {
  const SyntheticFlight flight(100, [](int i) {
    return std::array<double, 3>{i == 50 ? std::numeric_limits<double>::quiet_NaN() : 0.0, 0.0, 0.0};
  });
  EXPECT_TRUE(std::isnan(tracking_errors(flight.truth, flight.reference, {0, 100 * kStep}).rms_3d_m));
}

TEST(EnoughSamples, RequiresAQuarterOfTheSamples) {
  const Window window = {0, 1000 * kStep};
  const auto none = [](int) { return std::array<double, 3>{}; };
  const auto all = [](int) { return true; };
  const SyntheticFlight one_in_three(1000, none, all, [](int i) { return i % 3 == 0; });
  const SyntheticFlight one_in_five(1000, none, all, [](int i) { return i % 5 == 0; });
  EXPECT_TRUE(
      enough_samples(tracking_errors(one_in_three.truth, one_in_three.reference, window), window, 500.0));
  EXPECT_FALSE(
      enough_samples(tracking_errors(one_in_five.truth, one_in_five.reference, window), window, 500.0));
}

TEST(EnoughSamples, RejectsLongGaps) {
  const Window window = {0, 1000 * kStep};
  const auto none = [](int) { return std::array<double, 3>{}; };
  const auto gap_at = [&](int from, int length) {
    const SyntheticFlight flight(1000, none, [=](int i) { return i < from || i >= from + length; });
    return tracking_errors(flight.truth, flight.reference, window);
  };
  EXPECT_NEAR(gap_at(400, 200).longest_gap_s, 0.402, 1e-9);
  EXPECT_TRUE(enough_samples(gap_at(400, 100), window, 500.0));
  EXPECT_FALSE(enough_samples(gap_at(400, 200), window, 500.0));
  EXPECT_FALSE(enough_samples(gap_at(0, 200), window, 500.0)) << "at the window's start";
  EXPECT_FALSE(enough_samples(gap_at(800, 200), window, 500.0)) << "at the window's end";
}

TEST(Track, KeepsRowsThatFitAndCountsTheRest) {
  Track<MissionRow> track(3);
  for (int i = 0; i < 5; ++i) track.append({i, 0, 0, 0});
  ASSERT_EQ(track.size(), 3U);
  EXPECT_EQ(track.back().stamp_ns, 2);
  EXPECT_EQ(track.dropped(), 2U);
}

}  // namespace swiftlet::ground::tracking_test

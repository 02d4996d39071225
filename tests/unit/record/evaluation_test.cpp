#include "swiftlet/record/evaluation.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::record::evaluation_test {

constexpr std::int64_t kStep = 2'000'000;  // ns

// A flight of `count` samples whose truth is the reference plus error(i). keep_truth and keep_reference
// select the rows to record.
struct SyntheticFlight {
  std::vector<TruthRow> truth;
  std::vector<ReferenceRow> reference;

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
      if (keep_truth(i)) truth.push_back(flown);
      if (keep_reference(i)) reference.push_back(reference_row);
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
  const TrackingErrors errors = tracking_errors(flight.truth, flight.reference, {0, 1000 * kStep});
  EXPECT_EQ(errors.matched, 799U) << "of 800 references, the last is beyond the truth or the first before it";
  EXPECT_NEAR(errors.peak_3d_m, 0.001, 1e-9) << "the truth of the path is a cubic to within 1 nm";
}

TEST(TrackingErrors, DoNotInterpolateOverLongGaps) {
  const auto none = [](int) { return std::array<double, 3>{}; };
  const auto matched = [&](int missing) {
    const SyntheticFlight flight(100, none, [=](int i) { return i < 50 || i >= 50 + missing; });
    return tracking_errors(flight.truth, flight.reference, {0, 100 * kStep}).matched;
  };
  EXPECT_EQ(matched(24), 100U) << "50 ms between the rows";
  EXPECT_EQ(matched(25), 75U) << "52 ms between the rows";
}

TEST(MotionAt, InterpolatesAllOfARow) {
  std::vector<TruthRow> truth;
  TruthRow row;
  row.q_ned_from_frd = {1.0, 0.0, 0.0, 0.0};
  row.rotor_speeds = {100.0};
  row.supply_voltage_v = 4.0;
  truth.push_back(row);
  row.stamp_ns = 10'000'000;
  row.velocity_ned = {0.0, 0.0, 0.2};
  row.q_ned_from_frd = {-std::cos(0.1), 0.0, 0.0,
                        -std::sin(0.1)};  // the turn by 0.2 rad, with the other sign
  row.rotor_speeds = {200.0};
  row.supply_voltage_v = 3.8;
  truth.push_back(row);
  const auto at = motion_at(truth, truth.cbegin() + 1, 5'000'000);
  ASSERT_TRUE(at);
  EXPECT_EQ(at->stamp_ns, 5'000'000);
  EXPECT_NEAR(at->velocity_ned[2], 0.1, 1e-12);
  EXPECT_NEAR(at->q_ned_from_frd[0], std::cos(0.05), 1e-12);
  EXPECT_NEAR(at->q_ned_from_frd[3], std::sin(0.05), 1e-12);
  EXPECT_NEAR(at->rotor_speeds[0], 150.0, 1e-12);
  EXPECT_NEAR(at->supply_voltage_v, 3.9, 1e-12);
}

TEST(TrackingErrors, AreNaNWithoutAMatch) {
  const SyntheticFlight flight(
      100, [](int) { return std::array<double, 3>{}; }, [](int i) { return i % 40 == 0; },
      [](int i) { return i % 40 == 10; });
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

// References at 100 Hz, each in a mode; the truth is 1 mm off in the air and 1 m off in a landing.
class FlownFlight : public testing::Test {
 protected:
  static constexpr std::int64_t kPeriod = 10'000'000;  // ns

  void fly(control::Mode mode, int samples, double error_m = 0.001) {
    for (int i = 0; i < samples; ++i) {
      const std::int64_t stamp_ns = kPeriod * static_cast<std::int64_t>(flight_.reference.size());
      ReferenceRow reference;
      reference.stamp_ns = stamp_ns;
      reference.mode = static_cast<int>(mode);
      TruthRow truth;
      truth.stamp_ns = stamp_ns;
      truth.position_ned = {error_m, 0.0, 0.0};
      flight_.reference.push_back(reference);
      flight_.truth.push_back(truth);
    }
  }
  std::int64_t now_ns() const { return kPeriod * static_cast<std::int64_t>(flight_.reference.size()); }
  void says(std::uint64_t id, control::MissionState state, std::uint32_t item,
            const std::string& reason = "") {
    flight_.mission.push_back({now_ns(), id, static_cast<int>(state), item, 3, reason});
  }

  Flight flight_;
};

TEST_F(FlownFlight, OfAMissionCountsFromItsStartToItsLanding) {
  says(7, control::MissionState::kUploaded, 0);
  fly(control::Mode::kArmed, 20, 1.0);
  says(7, control::MissionState::kRunning, 0);
  fly(control::Mode::kMission, 300);
  says(7, control::MissionState::kRunning, 2);
  fly(control::Mode::kMission, 100, 1.0);
  says(7, control::MissionState::kCompleted, 2, control::to_string(control::Reason::kLanded));
  fly(control::Mode::kDisarmed, 50, 1.0);
  const Evaluation flown = evaluate(flight_);
  ASSERT_TRUE(flown.window);
  EXPECT_EQ(flown.window->from_ns, 20 * kPeriod);
  EXPECT_EQ(flown.window->to_ns, 320 * kPeriod);
  EXPECT_EQ(flown.mission_id, 7U);
  EXPECT_TRUE(flown.completed);
  EXPECT_NEAR(flown.duration_s, 4.0, 1e-9);
  EXPECT_EQ(flown.errors.matched, 300U);
  EXPECT_NEAR(flown.errors.peak_3d_m, 0.001, 1e-12);
  const std::vector<Window> landings = landing_items(flight_);
  ASSERT_EQ(landings.size(), 1U);
  EXPECT_EQ(landings[0].from_ns, 320 * kPeriod);
}

TEST_F(FlownFlight, OfAnAbortedMissionCountsToItsEnd) {
  says(7, control::MissionState::kRunning, 0);
  fly(control::Mode::kMission, 300);
  says(7, control::MissionState::kAborted, 1, "the battery is low");
  fly(control::Mode::kLanding, 100, 1.0);
  const Evaluation flown = evaluate(flight_);
  EXPECT_FALSE(flown.completed);
  EXPECT_EQ(flown.reason, "the battery is low");
  EXPECT_EQ(flown.errors.matched, 300U);
  EXPECT_NEAR(flown.duration_s, 3.0, 1e-9);
}

TEST_F(FlownFlight, OfAMissionThatTheRecordDoesNotSeeEndCountsWhatThereIs) {
  says(7, control::MissionState::kRunning, 0);
  fly(control::Mode::kMission, 300);
  const Evaluation flown = evaluate(flight_);
  EXPECT_FALSE(flown.completed);
  EXPECT_EQ(flown.reason, "");
  EXPECT_EQ(flown.errors.matched, 300U);
}

TEST_F(FlownFlight, OfSeveralMissionsIsTheFirst) {
  says(7, control::MissionState::kRunning, 0);
  fly(control::Mode::kMission, 100);
  says(7, control::MissionState::kCompleted, 2);
  fly(control::Mode::kHolding, 100, 1.0);
  says(8, control::MissionState::kRunning, 0);
  fly(control::Mode::kMission, 100, 1.0);
  says(8, control::MissionState::kCompleted, 2);
  const Evaluation flown = evaluate(flight_);
  EXPECT_EQ(flown.mission_id, 7U);
  EXPECT_EQ(flown.errors.matched, 100U);
  EXPECT_NEAR(flown.errors.peak_3d_m, 0.001, 1e-12);
}

TEST_F(FlownFlight, WithoutAMissionCountsFromTheTakeOffToTheLanding) {
  fly(control::Mode::kArmed, 50, 1.0);
  fly(control::Mode::kTakingOff, 100);
  fly(control::Mode::kHolding, 100);
  fly(control::Mode::kLanding, 100, 1.0);
  const Evaluation flown = evaluate(flight_);
  EXPECT_EQ(flown.mission_id, 0U);
  EXPECT_EQ(flown.errors.matched, 200U);
  EXPECT_NEAR(flown.errors.peak_3d_m, 0.001, 1e-12);
  EXPECT_NEAR(flown.duration_s, 1.99, 1e-6);
}

TEST_F(FlownFlight, OnTheGroundIsNone) {
  fly(control::Mode::kArmed, 50);
  EXPECT_FALSE(evaluate(flight_).window);
  EXPECT_FALSE(evaluate(Flight()).window);
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

// GIVEN a flight whose truth, poses and estimate have different errors WHEN the better ones are not recorded THEN it is judged by the next,
// and says so. Poses come at a fifth of the reference's rate, and every third is lost.
TEST(TrackingErrors, AreAgainstTheBestThatIsKnown) {
  const auto off_by = [](double metres) {
    return [metres](int) { return std::array<double, 3>{0.0, 0.0, metres}; };
  };
  Flight flight;
  flight.truth = SyntheticFlight(1000, off_by(0.001)).truth;
  flight.reference = SyntheticFlight(1000, off_by(0.0)).reference;
  for (const TruthRow& row : SyntheticFlight(1000, off_by(0.002)).truth) {
    plant::PoseSample pose;
    pose.stamp_ns = row.stamp_ns;
    if (row.stamp_ns % (5 * kStep) != 0) continue;
    pose.tracked = row.stamp_ns % (15 * kStep) != 0;
    pose.position_ned = {row.position_ned[0], row.position_ned[1], row.position_ned[2]};
    if (!pose.tracked) pose.position_ned.setConstant(1e3);
    flight.poses.push_back(pose);
  }
  for (const TruthRow& row : SyntheticFlight(1000, off_by(0.004)).truth) {
    EstimateRow estimate;
    estimate.stamp_ns = row.stamp_ns;
    estimate.position_ned = row.position_ned;
    estimate.velocity_ned = row.velocity_ned;
    flight.estimate.push_back(estimate);
  }
  const Window window{20 * kStep, 980 * kStep};
  const auto expect = [&](Against against, double metres, double tolerance) {
    const TrackingErrors errors = tracking_errors(flight, window);
    EXPECT_EQ(errors.against, against);
    EXPECT_EQ(errors.matched, 960U);
    EXPECT_NEAR(errors.rms_3d_m, metres, tolerance) << to_string(against);
    EXPECT_NEAR(errors.peak_3d_m, metres, 2.0 * tolerance) << to_string(against);
  };
  expect(Against::kGroundTruth, 0.001, 1e-12);
  flight.truth.clear();
  expect(Against::kMotionCapture, 0.002, 1e-4);  // at 5 m/s and 25 m/s^2
  for (plant::PoseSample& pose : flight.poses) pose.tracked = false;
  expect(Against::kEstimate, 0.004, 1e-12);
}

}  // namespace swiftlet::record::evaluation_test

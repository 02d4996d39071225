#include "swiftlet/plant/simulation/mocap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::tests::mocap_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::Mocap;
using plant::MocapSchedule;
using plant::MocapSettings;
using plant::PoseSample;
using plant::TruthSample;

constexpr std::int64_t kMillisecond = 1'000'000;

// A different pose at every stamp.
TruthSample truth_at(std::int64_t stamp_ns) {
  TruthSample truth;
  const double t = 1.0e-9 * static_cast<double>(stamp_ns);
  truth.stamp_ns = stamp_ns;
  truth.position_ned = {t, -2.0 * t, 0.5 * t};
  truth.q_ned_from_frd = Quaterniond(1.0, 0.1 * t, -0.2 * t, 0.3 * t).normalized();
  return truth;
}

MocapSettings perfect() {
  MocapSettings settings;
  settings.position_error_m = 0.0;
  settings.orientation_error_rad = 0.0;
  settings.misalignment_rad = 0.0;
  return settings;
}

double angle(const Quaterniond& a, const Quaterniond& b) { return a.angularDistance(b); }

TEST(Mocap, DeliversFramesOnTimeAtEveryRateAndLatency) {
  for (const double rate : {50.0, 100.0, 120.0, 200.0, 333.0}) {
    for (const double latency_s : {0.0, 0.0005, 0.004, 0.010, 0.035}) {
      SCOPED_TRACE(std::to_string(rate) + " Hz, " + std::to_string(latency_s) + " s");
      MocapSettings settings = perfect();
      settings.rate_hz = rate;
      settings.latency_s = latency_s;
      Mocap mocap(settings, 1);
      MocapSchedule schedule(settings, 1);
      const std::int64_t period = std::llround(1.0e9 / rate);
      const std::int64_t latency = std::llround(1.0e9 * latency_s);
      const auto next_step = [](std::int64_t t) {
        return (t + kMillisecond - 1) / kMillisecond * kMillisecond;
      };
      std::uint64_t count = 0;
      for (std::int64_t now = 0; now < 1000 * kMillisecond; now += kMillisecond) {
        const std::optional<PoseSample> pose = mocap.update(truth_at(now));
        const std::int64_t exposed = next_step(static_cast<std::int64_t>(count) * period);
        ASSERT_EQ(pose.has_value(), now == next_step(exposed + latency)) << now;
        if (pose) {
          ASSERT_EQ(pose->sequence, ++count);
          ASSERT_EQ(pose->stamp_ns, exposed);
          ASSERT_TRUE(pose->tracked);
          ASSERT_LT((pose->position_ned - truth_at(exposed).position_ned).norm(), 1.0e-12);
          ASSERT_LT(angle(pose->q_ned_from_frd, truth_at(exposed).q_ned_from_frd), 1.0e-7);
        }
        schedule.advance(now);
        ASSERT_EQ(schedule.delivered(), count) << now;
      }
      EXPECT_NEAR(static_cast<double>(count), rate * (1.0 - latency_s), 2.0);
    }
  }
}

TEST(Mocap, NeedsTheTruthOnlyAtScheduledEvents) {
  for (const double rate : {50.0, 100.0, 120.0, 240.0, 500.0, 1000.0}) {
    for (const double latency_s : {0.0, 0.0031, 0.010, 0.0457}) {
      SCOPED_TRACE(std::to_string(rate) + " Hz, " + std::to_string(latency_s) + " s");
      MocapSettings settings = perfect();
      settings.rate_hz = rate;
      settings.latency_s = latency_s;
      Mocap all(settings, 1);
      Mocap some(settings, 1);
      MocapSchedule schedule(settings, 1);
      int left_out = 0;
      for (std::int64_t now = 0; now <= 1'000 * kMillisecond; now += 2 * kMillisecond) {
        const auto of_all = all.update(truth_at(now));
        const MocapSchedule::Events events = schedule.advance(now);
        ASSERT_EQ(of_all.has_value(), events.delivers) << now;
        if (!events.exposes && !events.delivers) {
          ASSERT_FALSE(of_all.has_value()) << now;
          ++left_out;
          continue;
        }
        const auto of_some = some.update(truth_at(now));
        ASSERT_EQ(of_all.has_value(), of_some.has_value()) << now;
        if (of_all) {
          ASSERT_EQ(of_all->stamp_ns, of_some->stamp_ns) << now;
        }
      }
      if (rate <= 50.0) {
        EXPECT_GT(left_out, 250);
      }
    }
  }
}

TEST(Mocap, ErrorsStayWithinTheirBoundAndReachIt) {
  MocapSettings settings;
  settings.latency_s = 0.0;
  settings.misalignment_rad = 0.0;
  Mocap mocap(settings, 2);
  double worst_position = 0.0;
  double worst_angle = 0.0;
  Vector3d mean = Vector3d::Zero();
  constexpr int kFrames = 20'000;
  for (int i = 0; i < kFrames; ++i) {
    const TruthSample truth = truth_at(i * (10 * kMillisecond));
    const std::optional<PoseSample> pose = mocap.update(truth);
    ASSERT_TRUE(pose.has_value());
    const Vector3d error = pose->position_ned - truth.position_ned;
    mean += error / kFrames;
    worst_position = std::max(worst_position, error.norm());
    worst_angle = std::max(worst_angle, angle(pose->q_ned_from_frd, truth.q_ned_from_frd));
    ASSERT_LE(error.norm(), 1.0e-4 * (1.0 + 1.0e-9));
    ASSERT_NEAR(pose->q_ned_from_frd.norm(), 1.0, 1.0e-12);
  }
  EXPECT_LE(worst_angle, 1.4e-3 * (1.0 + 1.0e-6));
  EXPECT_GT(worst_position, 0.98e-4);
  EXPECT_GT(worst_angle, 0.98 * 1.4e-3);
  EXPECT_LT(mean.norm(), 0.03e-4);
}

TEST(Mocap, MisalignmentIsConstantInARun) {
  MocapSettings settings = perfect();
  settings.latency_s = 0.0;
  settings.misalignment_rad = 0.05;
  std::vector<Quaterniond> turns;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    Mocap mocap(settings, seed);
    for (int i = 0; i < 10; ++i) {
      const TruthSample truth = truth_at(i * (10 * kMillisecond));
      const PoseSample pose = mocap.update(truth).value();
      const Quaterniond turn = truth.q_ned_from_frd.conjugate() * pose.q_ned_from_frd;
      EXPECT_NEAR(angle(turn, Quaterniond::Identity()), 0.05, 0.05 * 1.0e-3);
      if (i == 0) turns.push_back(turn);
      EXPECT_LT(angle(turn, turns.back()), 1.0e-7);
    }
  }
  EXPECT_GT(angle(turns[0], turns[1]), 1.0e-3);
}

TEST(Mocap, DropoutsHaveTheirProbabilityAndLength) {
  MocapSettings settings = perfect();
  settings.latency_s = 0.0;
  settings.dropout_probability = 0.02;
  settings.dropout_length_s = 0.05;
  Mocap mocap(settings, 4);
  constexpr int kFrames = 200'000;
  int untracked = 0;
  int run = 0;
  for (int i = 0; i < kFrames; ++i) {
    const PoseSample pose = mocap.update(truth_at(i * (10 * kMillisecond))).value();
    ASSERT_EQ(pose.sequence, static_cast<std::uint64_t>(i + 1));
    if (!pose.tracked) {
      ++untracked;
      ++run;
      EXPECT_TRUE(pose.position_ned.isZero(0.0)) << "an untracked frame contains the position";
    } else {
      ASSERT_EQ(run % 5, 0) << "a dropout of " << run << " frames";
      run = 0;
    }
  }
  // A dropout of 5 begins every 1/p tracked frames on average: 5 p / (1 + 4 p) of all.
  EXPECT_NEAR(static_cast<double>(untracked) / kFrames, 0.1 / 1.08, 0.03 * 0.1 / 1.08);
}

TEST(Mocap, DropoutsDoNotChangeOtherFrames) {
  MocapSettings settings;
  settings.latency_s = 0.0;
  Mocap whole(settings, 7);
  settings.dropout_probability = 0.1;
  Mocap broken(settings, 7);
  int tracked = 0;
  for (int i = 0; i < 1000; ++i) {
    const PoseSample a = whole.update(truth_at(i * (10 * kMillisecond))).value();
    const PoseSample b = broken.update(truth_at(i * (10 * kMillisecond))).value();
    if (!b.tracked) continue;
    ++tracked;
    ASSERT_EQ(a.position_ned, b.position_ned);
    ASSERT_EQ(a.q_ned_from_frd.coeffs(), b.q_ned_from_frd.coeffs());
  }
  EXPECT_GT(tracked, 0);
  EXPECT_LT(tracked, 900);
}

TEST(Mocap, RestartsWithThePlant) {
  Mocap mocap(perfect(), 1);
  std::uint64_t last = 0;
  for (std::int64_t now = 0; now <= 105 * kMillisecond; now += kMillisecond) {
    if (const auto pose = mocap.update(truth_at(now))) last = pose->sequence;
  }
  EXPECT_EQ(last, 10U);  // exposed at 90 ms; the frame of 100 ms is under way and is lost
  for (std::int64_t now = 0; now < 10 * kMillisecond; now += kMillisecond)
    EXPECT_FALSE(mocap.update(truth_at(now)).has_value()) << now;
  const std::optional<PoseSample> pose = mocap.update(truth_at(10 * kMillisecond));
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->stamp_ns, 0);
  EXPECT_GT(pose->sequence, last);
}

TEST(Mocap, GapInTheTruthLosesItsFrames) {
  Mocap mocap(perfect(), 1);
  for (std::int64_t now = 0; now <= 20 * kMillisecond; now += kMillisecond) mocap.update(truth_at(now));
  // Nothing for 100 ms: the frame of 20 ms comes late, then one that is exposed at the gap's end.
  std::vector<PoseSample> poses;
  for (std::int64_t now = 123 * kMillisecond; now < 150 * kMillisecond; now += kMillisecond) {
    if (const auto pose = mocap.update(truth_at(now))) poses.push_back(*pose);
  }
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].stamp_ns, 20 * kMillisecond);
  EXPECT_EQ(poses[1].stamp_ns, 123 * kMillisecond);
  EXPECT_EQ(poses[2].stamp_ns, 130 * kMillisecond);
  EXPECT_EQ(poses[2].sequence, poses[0].sequence + 2);
}

// With uneven intervals the same seed gives the same frames, from all of the truth or only from the truth at
// scheduled events. Another seed gives other frames.
TEST(Mocap, UnevenFramesDependOnTheSeedOnly) {
  MocapSettings settings = perfect();
  settings.model = plant::MocapModel::kOptitrack;
  Mocap all(settings, 5);
  Mocap some(settings, 5);
  MocapSchedule schedule(settings, 5);
  MocapSchedule other(settings, 6);
  std::uint64_t handed_out = 0;
  int differences = 0;
  int left_out = 0;
  for (std::int64_t now = 0; now <= 60'000 * kMillisecond; now += 2 * kMillisecond) {
    const auto of_all = all.update(truth_at(now));
    const MocapSchedule::Events events = schedule.advance(now);
    if (of_all) handed_out = of_all->sequence;
    ASSERT_EQ(schedule.delivered(), handed_out) << now;
    if (other.advance(now).exposes != events.exposes) ++differences;
    if (!events.exposes && !events.delivers) {
      ++left_out;
      continue;
    }
    const auto of_some = some.update(truth_at(now));
    ASSERT_EQ(of_all.has_value(), of_some.has_value()) << now;
    if (of_all) {
      ASSERT_EQ(of_all->stamp_ns, of_some->stamp_ns) << now;
    }
  }
  EXPECT_NEAR(static_cast<double>(handed_out), 60.0 / 0.0183, 200.0);
  EXPECT_GT(differences, 1000);
  EXPECT_GT(left_out, 20'000);
}

}  // namespace swiftlet::tests::mocap_test

#include "swiftlet/plant/simulation/links/faults.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::faults_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::ActuatorCommand;
using plant::CommandPath;
using plant::Fault;
using plant::FaultKind;
using plant::FaultSchedule;
using plant::MocapPath;
using plant::PlantSimulation;
using plant::PoseSample;
using plant::SimulationSettings;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kFramePeriod = 10 * kMillisecond;

Fault fault(FaultKind kind, double at_s, double for_s) {
  Fault fault;
  fault.kind = kind;
  fault.at_s = at_s;
  fault.for_s = for_s;
  return fault;
}

std::vector<std::string> violations_of(const std::vector<Fault>& faults) {
  plant::RuleChecker check;
  plant::check_faults(faults, 0.001, check);
  std::vector<std::string> sentences;
  for (const plant::Violation& violation : check.take())
    sentences.push_back(violation.key + ": " + violation.message);
  return sentences;
}

TEST(FaultSchedule, FaultsAreActiveFromStartUpToEnd) {
  const FaultSchedule schedule({fault(FaultKind::kImuStop, 3.0, 0.5), fault(FaultKind::kImuStop, 1.0, 0.25),
                                fault(FaultKind::kMocapStop, 1.1, 0.1)});
  for (std::int64_t t = 0; t < 5'000 * kMillisecond; t += kMillisecond) {
    const bool first = t >= 1'000 * kMillisecond && t < 1'250 * kMillisecond;
    const bool second = t >= 3'000 * kMillisecond && t < 3'500 * kMillisecond;
    ASSERT_EQ(schedule.active(FaultKind::kImuStop, t) != nullptr, first || second) << t;
    ASSERT_EQ(schedule.active(FaultKind::kPush, t), nullptr);
  }
  std::vector<std::int64_t> changes;
  for (std::int64_t t = -1; (t = schedule.next_change_ns(t)) != FaultSchedule::kNever;)
    changes.push_back(t / kMillisecond);
  EXPECT_EQ(changes, (std::vector<std::int64_t>{1000, 1100, 1200, 1250, 3000, 3500}));
}

TEST(FaultSchedule, ReportsViolations) {
  EXPECT_TRUE(violations_of({fault(FaultKind::kImuStop, 0.0, 1.0), fault(FaultKind::kImuStop, 1.0, 1.0),
                             fault(FaultKind::kImuNan, 0.5, 1.0)})
                  .empty());
  EXPECT_EQ(violations_of({fault(FaultKind::kImuStop, -1.0, 1.0)}),
            std::vector<std::string>{"faults[0].at_s: is -1, must be at least 0 and at most 86400"});
  EXPECT_EQ(violations_of({fault(FaultKind::kImuStop, 1.0, 0.0001)}),
            std::vector<std::string>{"faults[0].for_s: is 0.0001, must be at least 0.001 and at most 86400"});
  EXPECT_EQ(
      violations_of({fault(FaultKind::kImuStop, 1.0, 2.0), fault(FaultKind::kImuStop, 2.5, 1.0)}),
      std::vector<std::string>{"faults[1].at_s: is 2.5, but faults[0], imu_stop too, lasts from 1 s to 3 s: "
                               "faults of one kind must not overlap"});
  Fault late = fault(FaultKind::kMocapLatency, 1.0, 1.0);
  late.delay_s = 5.0;
  EXPECT_EQ(violations_of({late}),
            std::vector<std::string>{"faults[0].delay_s: is 5, must be at least 0.001 and at most 1"});
  Fault jump = fault(FaultKind::kMocapJump, 1.0, 1.0);
  jump.position_ned.y() = std::nan("");
  EXPECT_EQ(violations_of({jump}).size(), 1U);
  Fault rotor = fault(FaultKind::kRotorThrust, 1.0, 1.0);
  rotor.rotor = 5;
  EXPECT_TRUE(violations_of({rotor}).empty());
  const auto of_vehicle = plant::validate_faults({rotor}, kaylion());
  ASSERT_EQ(of_vehicle.size(), 1U);
  EXPECT_EQ(of_vehicle[0].message, "is 5, must be at most 4, the rotors of kaylion");
}

// Frames of a moving body every 10 ms, through a path that is polled every millisecond.
class MocapFaults : public testing::Test {
 protected:
  static PoseSample frame_at(std::int64_t stamp_ns) {
    PoseSample frame;
    frame.stamp_ns = stamp_ns;
    frame.sequence = static_cast<std::uint64_t>(stamp_ns / kFramePeriod + 1);
    frame.tracked = true;
    frame.position_ned = {1e-9 * static_cast<double>(stamp_ns), 2.0, -1.0};
    return frame;
  }

  struct Delivered {
    std::int64_t at_ms;
    PoseSample frame;
  };

  static std::vector<Delivered> deliver(const std::vector<Fault>& faults, std::int64_t to_ms) {
    SimulationSettings settings;
    settings.faults = faults;
    MocapPath path(settings, 1);
    std::vector<Delivered> delivered;
    for (std::int64_t ms = 0; ms < to_ms; ++ms) {
      const std::int64_t now = ms * kMillisecond;
      std::optional<PoseSample> frame;
      if (now % kFramePeriod == 0) frame = frame_at(now);
      if (const auto out = path.pass(frame, now)) delivered.push_back({ms, *out});
    }
    return delivered;
  }
};

TEST_F(MocapFaults, StopDropsFramesAndSequenceNumbersContinue) {
  std::vector<std::uint64_t> numbers;
  for (const Delivered& d : deliver({fault(FaultKind::kMocapStop, 0.02, 0.03)}, 80))
    numbers.push_back(d.frame.sequence);
  EXPECT_EQ(numbers, (std::vector<std::uint64_t>{1, 2, 6, 7, 8}));
}

TEST_F(MocapFaults, FreezeRepeatsThePoseWithNewStampsAndSequenceNumbers) {
  for (const Delivered& d : deliver({fault(FaultKind::kMocapFreeze, 0.02, 0.03)}, 80)) {
    const bool frozen = d.at_ms >= 20 && d.at_ms < 50;
    const PoseSample unfaulted = frame_at(d.at_ms * kMillisecond);
    EXPECT_EQ(d.frame.position_ned, frozen ? frame_at(kFramePeriod).position_ned : unfaulted.position_ned);
    EXPECT_EQ(d.frame.stamp_ns, unfaulted.stamp_ns);
    EXPECT_EQ(d.frame.sequence, unfaulted.sequence);
    EXPECT_TRUE(d.frame.tracked);
  }
}

TEST_F(MocapFaults, FreezeRepeatsTheLastTrackedPose) {
  SimulationSettings settings;
  settings.faults = {fault(FaultKind::kMocapFreeze, 0.02, 0.03)};
  MocapPath path(settings, 1);
  path.pass(frame_at(0), 0);
  PoseSample untracked = frame_at(kFramePeriod);
  untracked.tracked = false;
  EXPECT_FALSE(path.pass(untracked, kFramePeriod)->tracked);
  const auto frozen = path.pass(frame_at(2 * kFramePeriod), 2 * kFramePeriod);
  EXPECT_TRUE(frozen->tracked);
  EXPECT_EQ(frozen->position_ned, frame_at(0).position_ned);
}

TEST_F(MocapFaults, UntrackedFramesContainNoPosition) {
  int untracked = 0;
  for (const Delivered& d : deliver({fault(FaultKind::kMocapUntracked, 0.02, 0.03)}, 80)) {
    if (d.frame.tracked) continue;
    ++untracked;
    EXPECT_TRUE(d.frame.position_ned.isZero(0.0));
    EXPECT_EQ(d.frame.sequence, frame_at(d.at_ms * kMillisecond).sequence);
  }
  EXPECT_EQ(untracked, 3);
}

TEST_F(MocapFaults, JumpOffsetsAndRotatesPoses) {
  Fault jump = fault(FaultKind::kMocapJump, 0.02, 0.03);
  jump.position_ned = {0.5, -0.25, 0.125};
  jump.rotation_frd = {0.0, 0.0, M_PI};
  for (const Delivered& d : deliver({jump}, 80)) {
    const bool off = d.at_ms >= 20 && d.at_ms < 50;
    const Vector3d offset = d.frame.position_ned - frame_at(d.at_ms * kMillisecond).position_ned;
    EXPECT_LT((offset - (off ? jump.position_ned : Vector3d(0, 0, 0))).norm(), 1e-12);
    EXPECT_NEAR(d.frame.q_ned_from_frd.angularDistance(Quaterniond::Identity()), off ? M_PI : 0.0, 1e-9);
  }
}

// The rotation is about the axes of the body, FRD, as its name says.
TEST_F(MocapFaults, JumpRotatesAboutTheAxesOfTheBody) {
  SimulationSettings settings;
  settings.faults = {fault(FaultKind::kMocapJump, 0.0, 0.03)};
  settings.faults.front().rotation_frd = {0.4, 0.0, 0.0};
  MocapPath path(settings, 1);
  PoseSample yawed = frame_at(0);
  yawed.q_ned_from_frd = Eigen::AngleAxisd(1.0, Vector3d::UnitZ());
  const Quaterniond rolled = yawed.q_ned_from_frd * Quaterniond(Eigen::AngleAxisd(0.4, Vector3d::UnitX()));
  EXPECT_LT(path.pass(yawed, 0)->q_ned_from_frd.angularDistance(rolled), 1e-9);
}

TEST_F(MocapFaults, SwapShowsAnotherBodyAtRestWithNoise) {
  Fault swap = fault(FaultKind::kMocapSwap, 0.02, 0.03);
  swap.position_ned = {-1.0, 1.0, 0.0};
  swap.yaw_rad = 1.0;
  const Quaterniond turned(Eigen::AngleAxisd(1.0, Vector3d::UnitZ()));
  std::optional<Vector3d> before;
  for (const Delivered& d : deliver({swap}, 80)) {
    if (d.at_ms < 20 || d.at_ms >= 50) continue;
    EXPECT_LE((d.frame.position_ned - swap.position_ned).norm(), 1.01e-4);
    EXPECT_LT(d.frame.q_ned_from_frd.angularDistance(turned), 1e-9);
    if (before) {
      EXPECT_NE(d.frame.position_ned, *before);
    }
    before = d.frame.position_ned;
  }
  EXPECT_TRUE(before.has_value());
}

TEST_F(MocapFaults, LatencyDelaysFramesAndDropsOvertakenOnes) {
  Fault late = fault(FaultKind::kMocapLatency, 0.02, 0.04);
  late.delay_s = 0.025;
  std::vector<std::pair<std::int64_t, std::int64_t>> times;
  for (const Delivered& d : deliver({late}, 90)) times.emplace_back(d.at_ms, d.frame.stamp_ns / kMillisecond);
  // The frames of 20 and 30 ms arrive at 45 and 55. The fault ends at 60, and the frame of 60 overtakes two.
  EXPECT_EQ(times, (std::vector<std::pair<std::int64_t, std::int64_t>>{
                       {0, 0}, {10, 10}, {45, 20}, {55, 30}, {60, 60}, {70, 70}, {80, 80}}));
}

TEST_F(MocapFaults, RestartWithThePlant) {
  SimulationSettings settings;
  settings.faults = {fault(FaultKind::kMocapLatency, 0.02, 0.5)};
  settings.faults[0].delay_s = 0.2;
  MocapPath path(settings, 1);
  for (std::int64_t t = 0; t < 100 * kMillisecond; t += kFramePeriod) path.pass(frame_at(t), t);
  // No frame from before the restart arrives after it.
  for (std::int64_t t = 0; t < 300 * kMillisecond; t += kMillisecond) {
    const auto out = path.pass(std::nullopt, t);
    EXPECT_FALSE(out.has_value()) << t;
  }
}

TEST(CommandFaults, StopDropsCommandsAndDelayPostponesThem) {
  SimulationSettings settings;
  settings.imu.rate_hz = 1000.0;  // a command for each sample
  settings.faults = {fault(FaultKind::kCommandsStop, 0.01, 0.01),
                     fault(FaultKind::kCommandsDelay, 0.03, 0.01)};
  settings.faults[1].delay_s = 0.005;
  CommandPath path(settings, 1);
  for (std::int64_t ms = 0; ms < 60; ++ms) {
    const std::int64_t now = ms * kMillisecond;
    ActuatorCommand command;
    command.stamp_ns = now;
    const auto late = path.arrived(now);
    const bool at_once = path.send(command, now);
    const bool stopped = ms >= 10 && ms < 20;
    const bool delayed = ms >= 30 && ms < 40;
    ASSERT_EQ(at_once, !stopped && !delayed) << ms;
    // From 40 ms on the commands under way are overtaken.
    ASSERT_EQ(late.has_value(), ms >= 35 && ms <= 40) << ms;
    if (late) {
      ASSERT_EQ(plant::header_of(*late).stamp_ns, now - 5 * kMillisecond);
    }
  }
}

class PlantFaults : public testing::Test {
 protected:
  static PlantSimulation plant(const std::vector<Fault>& faults, SimulationSettings settings) {
    settings.faults = faults;
    return {kaylion(), settings, 1};
  }
};

TEST_F(PlantFaults, ChangeOnlyTheAffectedSamples) {
  Fault bias = fault(FaultKind::kImuBias, 0.5, 0.1);
  bias.specific_force_frd = {1.0, 2.0, 3.0};
  bias.body_rates_frd = {0.1, 0.2, 0.3};
  const SimulationSettings settings;
  PlantSimulation faulty =
      plant({fault(FaultKind::kImuStop, 0.1, 0.05), fault(FaultKind::kImuNan, 0.2, 0.05),
             fault(FaultKind::kImuStuck, 0.3, 0.05), bias, fault(FaultKind::kBatteryStop, 0.15, 0.1),
             fault(FaultKind::kRotorSpeedsStop, 0.1, 0.05)},
            settings);
  PlantSimulation unfaulted = plant({}, settings);
  std::optional<plant::ImuSample> before_stuck;
  int missing = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    ASSERT_EQ(faulty.imu_due(), unfaulted.imu_due());
    ASSERT_EQ(faulty.imu_count(), unfaulted.imu_count());
    const bool stopped = ms >= 100 && ms < 150;
    ASSERT_EQ(faulty.imu().has_value(), unfaulted.imu().has_value() && !stopped) << ms;
    if (unfaulted.imu() && stopped) ++missing;
    if (faulty.imu()) {
      const plant::ImuSample& a = *faulty.imu();
      const plant::ImuSample& b = *unfaulted.imu();
      ASSERT_EQ(a.sequence, b.sequence);
      ASSERT_EQ(a.stamp_ns, b.stamp_ns);
      if (ms >= 200 && ms < 250) {
        ASSERT_TRUE(a.specific_force_frd.hasNaN() && a.body_rates_frd.hasNaN());
      } else if (ms >= 300 && ms < 350) {
        ASSERT_EQ(a.specific_force_frd, before_stuck->specific_force_frd);
        ASSERT_EQ(a.body_rates_frd, before_stuck->body_rates_frd);
      } else {
        const double share = ms >= 500 && ms < 600 ? 1.0 : 0.0;
        ASSERT_EQ(a.specific_force_frd, b.specific_force_frd + share * bias.specific_force_frd) << ms;
        ASSERT_EQ(a.body_rates_frd, b.body_rates_frd + share * bias.body_rates_frd) << ms;
        before_stuck = a;
      }
    }
    const bool no_battery = ms >= 150 && ms < 250;
    ASSERT_EQ(faulty.battery().has_value(), unfaulted.battery().has_value() && !no_battery);
    ASSERT_EQ(faulty.rotor_speeds().has_value(), unfaulted.rotor_speeds().has_value() && !stopped);
    ASSERT_EQ(faulty.state().position_ned, unfaulted.state().position_ned);
    faulty.step(running(0.4));
    unfaulted.step(running(0.4));
  }
  EXPECT_EQ(missing, 25);
}

// The momentum changes by the impulse, and the accelerometer measures the force.
TEST_F(PlantFaults, PushChangesTheVelocityByItsImpulse) {
  const plant::Vehicle& vehicle = kaylion();
  Fault push = fault(FaultKind::kPush, 0.1, 0.05);
  push.force_ned = {0.4, -0.2, 0.1};
  push.moment_frd = {0.0, 0.0, 1.0e-4};
  PlantSimulation plant = this->plant({push}, empty_space());
  for (int ms = 0; ms < 200; ++ms) {
    if (plant.imu() && ms > 100 && ms <= 150) {
      const Vector3d expected = plant.state().q_ned_from_frd.conjugate() * (push.force_ned / vehicle.mass_kg);
      ASSERT_LT((plant.imu()->specific_force_frd - expected).norm(), 1e-9) << ms;
    }
    plant.step({});
  }
  const Vector3d fallen(0.0, 0.0, plant::kGravity * 0.2);
  EXPECT_LT((plant.state().velocity_ned - fallen - push.force_ned * 0.05 / vehicle.mass_kg).norm(), 1e-9);
  EXPECT_NEAR(plant.state().body_rates_frd.z(), 1.0e-4 * 0.05 / vehicle.inertia(2, 2), 1e-9);
}

TEST_F(PlantFaults, LossOfRotorThrustRotatesTheBody) {
  Fault lost = fault(FaultKind::kRotorThrust, 0.3, 0.1);
  lost.rotor = 1;  // front right: the body rolls right and pitches down
  lost.factor = 0.0;
  PlantSimulation plant = this->plant({lost}, empty_space());
  for (int ms = 0; ms < 300; ++ms) plant.step(running(0.4));
  ASSERT_LT(plant.state().body_rates_frd.norm(), 1e-9);
  for (int ms = 0; ms < 100; ++ms) plant.step(running(0.4));
  EXPECT_GT(plant.state().body_rates_frd.x(), 1.0);
  EXPECT_LT(plant.state().body_rates_frd.y(), -1.0);
  const Vector3d rates = plant.state().body_rates_frd;
  for (int ms = 0; ms < 50; ++ms) plant.step(running(0.4));
  EXPECT_LT((plant.state().body_rates_frd - rates).norm(), 0.05 * rates.norm());
}

TEST_F(PlantFaults, BatteryDropIsMeasuredAndSlowsTheRotors) {
  Fault drop = fault(FaultKind::kBatteryDrop, 1.0, 0.5);
  drop.voltage_v = 0.5;
  PlantSimulation faulty = plant({drop}, SimulationSettings());
  PlantSimulation unfaulted = plant({}, SimulationSettings());
  for (int ms = 0; ms < 1450; ++ms) {
    faulty.step(running(0.2));
    unfaulted.step(running(0.2));
  }
  EXPECT_NEAR(unfaulted.truth().supply_voltage_v - faulty.truth().supply_voltage_v, 0.5, 0.1);
  EXPECT_LT(faulty.truth().rotor_speeds[0], 0.95 * unfaulted.truth().rotor_speeds[0]);
  for (int ms = 0; ms < 1000; ++ms) {
    faulty.step(running(0.2));
    unfaulted.step(running(0.2));
  }
  EXPECT_NEAR(faulty.truth().rotor_speeds[0], unfaulted.truth().rotor_speeds[0],
              0.001 * unfaulted.truth().rotor_speeds[0]);
}

TEST_F(PlantFaults, WindAcceleratesAVehicleWithDrag) {
  plant::Vehicle vehicle = kaylion();
  vehicle.linear_drag = 0.02;
  SimulationSettings settings = empty_space();
  settings.air.drag = true;
  Fault wind = fault(FaultKind::kWind, 0.0, 0.1);
  wind.wind_ned = {3.0, 0.0, 0.0};
  settings.faults = {wind};
  PlantSimulation plant(vehicle, settings, 1);
  for (int ms = 0; ms < 100; ++ms) plant.step({});
  const double v = 3.0 * (1.0 - std::exp(-0.1 * vehicle.linear_drag / vehicle.mass_kg));
  EXPECT_NEAR(plant.state().velocity_ned.x(), v, 1e-9);
  for (int ms = 0; ms < 100; ++ms) plant.step({});
  EXPECT_NEAR(plant.state().velocity_ned.x(), v * std::exp(-0.1 * vehicle.linear_drag / vehicle.mass_kg),
              1e-9);
}

}  // namespace swiftlet::tests::faults_test

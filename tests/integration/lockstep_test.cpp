// Lockstep: flights repeat exactly, and end when a peer falls silent.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

const std::string kMission =
    "name: hop\n"
    "frame: ned\n"
    "tolerance_m: 0.1\n"
    "items:\n"
    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [0.5, -0.3, -0.7], yaw_rad: 0.5, speed_m_s: 0.5}\n"
    "  - {kind: land, speed_m_s: 0.5}\n";

// Loads every core during its lifetime.
class CpuLoad {
 public:
  CpuLoad() {
    for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) {
      threads_.emplace_back([this] {
        volatile double x = 1.0;
        while (!end_.load(std::memory_order_relaxed)) x = x * 1.0000001;
      });
    }
  }
  ~CpuLoad() {
    end_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> end_{false};
  std::vector<std::thread> threads_;
};

class Lockstep : public testing::Test {
 protected:
  struct Flight {
    json report;
    std::string trace;
  };

  // words: the command line without mission and record.
  Flight fly(std::vector<std::string> words, const std::string& name) {
    const auto record = folder_.path() / name;
    words.insert(words.end(), {mission_, "--trace", "--json", "--record", record.string()});
    const ProgramResult result = run_program("swiftlet", words, folder_.path(), kStuck);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return {json::parse(result.output), contents(record / "trace.csv")};
  }

  TemporaryFolder folder_;
  std::string mission_ = folder_.write("hop.yaml", kMission);
};

record::Flight recorded(const std::filesystem::path& folder) {
  return record::read_flight(mcap::Reader(folder / record::kFlightFile), "kl1");
}

// No sample is lost on the way to the record, whatever the load.
void expect_every_sample(const record::Flight& over_dds, const record::Flight& in_process) {
  ASSERT_GT(in_process.imu.size(), 2'000U);
  const auto expect_all = [](const auto& sent, const auto& expected, const auto& equal) {
    auto at = sent.begin();
    for (const auto& sample : expected) {
      at = std::find_if(at, sent.end(), [&](const auto& one) { return one.stamp_ns >= sample.stamp_ns; });
      ASSERT_NE(at, sent.end()) << sample.stamp_ns;
      ASSERT_EQ(at->stamp_ns, sample.stamp_ns);
      ASSERT_TRUE(equal(*at, sample)) << sample.stamp_ns;
    }
  };
  expect_all(over_dds.imu, in_process.imu, [](const auto& a, const auto& b) {
    return a.specific_force_frd == b.specific_force_frd && a.body_rates_frd == b.body_rates_frd;
  });
  expect_all(over_dds.commands, in_process.commands,
             [](const auto& a, const auto& b) { return a.throttle == b.throttle; });
  expect_all(over_dds.poses, in_process.poses,
             [](const auto& a, const auto& b) { return a.position_ned == b.position_ned; });
}

// GIVEN one seed WHEN the mission is flown in one process, over DDS, over DDS beside other processes on all cores, and at a
// limited speed THEN all flights are the same, and another seed flies another.
TEST_F(Lockstep, FliesTheSameFlightHoweverItRuns) {
  constexpr double kSpeed = 4.0;
  const std::vector<std::string> lockstep = {"fly", "--clock", "lockstep", "--seed", "3"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), lockstep.begin(), lockstep.end());
    return more;
  };
  const Flight in_process = fly({"sim", "fly", "--seed", "3"}, "process");
  EXPECT_GT(in_process.trace.size(), 1'000'000U);
  EXPECT_FALSE(in_process.trace == fly({"sim", "fly", "--seed", "4"}, "other").trace);
  const auto started = std::chrono::steady_clock::now();
  const Flight slow = fly(with({"--speed", std::to_string(kSpeed)}), "slow");
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  EXPECT_GE(elapsed.count(), slow.report.at("duration_s").get<double>() / kSpeed);
  const CpuLoad load;
  const Flight under_load = fly(lockstep, "load");
  for (const Flight* over_dds : {&slow, &under_load}) {
    EXPECT_TRUE(over_dds->trace == in_process.trace);
    EXPECT_EQ(over_dds->report.at("clock"), "lockstep");
    for (const char* key : {"rms_3d_m", "peak_3d_m", "rms_m", "peak_m", "matched_samples", "duration_s"})
      EXPECT_EQ(over_dds->report.at(key), in_process.report.at(key)) << key;
  }
  expect_every_sample(recorded(folder_.path() / "load"), recorded(folder_.path() / "process"));
}

// At the other rate of the IMU; and the plant waits for frames with random times.
TEST_F(Lockstep, EqualsTheFlightInOneProcessAtOneKilohertzWithMocapJitter) {
  const std::vector<std::string> options = {
      "--seed", "7", "--imu-rate", "1000", "--simulation", "simulation/optitrack.yaml"};
  std::vector<std::string> over_dds = {"fly", "--clock", "lockstep"};
  std::vector<std::string> in_process = {"sim", "fly"};
  over_dds.insert(over_dds.end(), options.begin(), options.end());
  in_process.insert(in_process.end(), options.begin(), options.end());
  const Flight dds = fly(over_dds, "dds");
  EXPECT_GT(dds.trace.size(), 2'000'000U);
  EXPECT_TRUE(dds.trace == fly(in_process, "process").trace);
  // One control step for each IMU sample.
  EXPECT_GT(dds.report.at("cycles"), 950.0 * dds.report.at("duration_s").get<double>());
  EXPECT_LT(dds.report.at("cycles"), 1050.0 * dds.report.at("simulated_s").get<double>());
  EXPECT_LT(dds.report.at("rms_3d_m"), 0.010);
}

// Every kind of fault of a vehicle that brings an IMU. The plant does not wait for samples that a fault suppresses; all others
// arrive at the same stamp.
TEST_F(Lockstep, EqualsTheFlightInOneProcessWithFaults) {
  std::ifstream world(in_source("config/simulation/default.yaml"));
  const std::string simulation = folder_.write(
      "faults.yaml",
      std::string(std::istreambuf_iterator<char>(world), {}) +
          "faults:\n"
          "  - {kind: imu_stop, at_s: 0.2, for_s: 0.1}\n"
          "  - {kind: mocap_stop, at_s: 0.25, for_s: 0.1}\n"
          "  - {kind: mocap_latency, at_s: 1.5, for_s: 0.5, delay_s: 0.017}\n"
          "  - {kind: imu_stop, at_s: 2.503, for_s: 0.015}\n"
          "  - {kind: mocap_stop, at_s: 3.5, for_s: 0.15}\n"
          "  - {kind: imu_stop, at_s: 3.6, for_s: 0.025}\n"
          "  - {kind: imu_nan, at_s: 4, for_s: 0.02}\n"
          "  - {kind: mocap_freeze, at_s: 4.3, for_s: 0.05}\n"
          "  - {kind: mocap_untracked, at_s: 4.5, for_s: 0.05}\n"
          "  - {kind: mocap_swap, at_s: 4.7, for_s: 0.05, position_ned_m: [1, 1, 0], yaw_rad: 1}\n"
          "  - {kind: commands_stop, at_s: 5, for_s: 0.03}\n"
          "  - {kind: commands_delay, at_s: 5.2, for_s: 0.1, delay_s: 0.007}\n"
          "  - {kind: mocap_jump, at_s: 5.4, for_s: 0.05, position_ned_m: [0.5, 0, 0], rotation_frd_rad: [0, "
          "0, "
          "1]}\n"
          "  - {kind: imu_stuck, at_s: 5.6, for_s: 0.01}\n"
          "  - {kind: imu_bias, at_s: 5.8, for_s: 0.2, accelerometer_m_s2: [0.2, 0, 0.1], gyro_rad_s: [0, "
          "0.02, 0]}\n"
          "  - {kind: battery_drop, at_s: 4, for_s: 0.5, voltage_v: 0.3}\n"
          "  - {kind: rotor_thrust, at_s: 6, for_s: 0.2, rotor: 2, factor: 0.95}\n"
          "  - {kind: wind, at_s: 6, for_s: 0.2, wind_ned_m_s: [1, 0, 0]}\n"
          "  - {kind: battery_stop, at_s: 5, for_s: 0.5}\n"
          "  - {kind: rotor_speeds_stop, at_s: 5, for_s: 0.5}\n"
          "  - {kind: push, at_s: 5.5, for_s: 0.05, force_ned_n: [0.1, 0, 0], moment_frd_n_m: [0, 0, 0]}\n");
  const Flight over_dds = fly({"fly", "--clock", "lockstep", "--simulation", simulation}, "dds");
  const Flight in_process = fly({"sim", "fly", "--simulation", simulation}, "process");
  const Flight without = fly({"sim", "fly"}, "without");
  EXPECT_GT(in_process.trace.size(), 1'000'000U);
  EXPECT_TRUE(over_dds.trace == in_process.trace);
  EXPECT_FALSE(without.trace == in_process.trace);
  for (const char* key : {"rms_3d_m", "peak_3d_m", "matched_samples", "duration_s"}) {
    EXPECT_EQ(over_dds.report.at(key), in_process.report.at(key)) << key;
  }
}

// Polynomials of a third-party file, sent in one message and evaluated bit for bit.
TEST_F(Lockstep, EqualsTheFlightInOneProcessOnATrajectory) {
  mission_ = in_source("tests/data/crazyswarm_figure8.csv");
  const Flight over_dds = fly({"fly", "--clock", "lockstep", "--seed", "8"}, "dds");
  const Flight in_process = fly({"sim", "fly", "--seed", "8"}, "process");
  EXPECT_GT(in_process.trace.size(), 1'000'000U);
  EXPECT_TRUE(over_dds.trace == in_process.trace);
  EXPECT_EQ(over_dds.report.at("rms_3d_m"), in_process.report.at("rms_3d_m"));
}

// The services in lockstep without a ground tool.
class LockstepServices : public testing::Test {
 protected:
  std::unique_ptr<Program> start(const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.end(),
                {"--clock", "lockstep", "--localhost-only", "--domain", std::to_string(domain_.domain())});
    return std::make_unique<Program>(name, more, folder_.path());
  }

  dds::DomainLock domain_;
  TemporaryFolder folder_;
};

// Each peer may start after the plant, which names it while it waits, and says when it ends.
TEST_F(LockstepServices, PlantWaitsForAPeerAndReportsItsEnd) {
  for (const std::string late : {"mocap", "control"}) {
    const auto there = start(late == "mocap" ? "swiftlet-control" : "swiftlet-mocap");
    const auto plant = start("swiftlet-plant", {"--patience", "0.5"});
    ASSERT_TRUE(eventually([&] { return contains(plant->errors(), "waiting for " + late + "\n"); }))
        << plant->errors();
    const auto peer = start("swiftlet-" + late);
    const Program& control = late == "mocap" ? *there : *peer;
    ASSERT_TRUE(eventually([&] {
      return contains(control.errors(), "mocap available") && contains(control.errors(), "role is active");
    })) << control.errors();
    peer->signal(SIGKILL);
    EXPECT_EQ(plant->wait(kStuck), 1);
    EXPECT_TRUE(contains(plant->errors(), "lockstep: " + late + " is silent: ")) << plant->errors();
  }
}

// The plant repeats a truth whose answer was lost. The repetition is answered again and is no gap.
TEST_F(LockstepServices, MocapAnswersARepeatedTruthAgain) {
  const auto mocap = start("swiftlet-mocap");
  dds::NodeSettings settings;
  settings.name = "plant";
  settings.domain = domain_.domain();
  dds::Node plant(settings);
  Inbox<messages::msg::MocapPose> poses;
  const auto subscription = plant.subscribe<messages::msg::MocapPose>(
      messages::topics::kMocapPose, [&](const auto& pose) { poses.put(pose); });
  auto truths = plant.publish(messages::topics::kGroundTruth);
  messages::msg::GroundTruth truth;
  truth.q_ned_from_frd({1.0, 0.0, 0.0, 0.0});
  truth.rotor_count(4);
  for (std::uint64_t sequence = 1; sequence <= 40; ++sequence) {
    truth.sequence_number(sequence);
    truth.stamp_ns(static_cast<std::int64_t>(sequence - 1) * 1'000'000);
    for (const char* time : {"first", "again"}) {
      poses.clear();
      ASSERT_TRUE(eventually(
          [&] {
            truths.publish(truth);
            return poses.wait([](const auto& all) { return !all.empty(); }, 200ms) || mocap->exit_code();
          },
          kStuck))
          << time << " " << sequence << ": " << mocap->errors();
      ASSERT_FALSE(mocap->exit_code()) << time << " " << sequence << ": " << mocap->errors();
    }
  }
  mocap->signal(SIGTERM);
  EXPECT_EQ(mocap->wait(kStuck), 0) << mocap->errors();
}

// Time advances up to each simulation clock message; without further messages, the plant ends the run.
TEST_F(LockstepServices, TimeAdvancesWithTheSimulationClockOnly) {
  const auto mocap = start("swiftlet-mocap");
  const auto control = start("swiftlet-control");
  const auto plant = start("swiftlet-plant", {"--paused", "--patience", "0.5"});
  {
    dds::NodeSettings settings;
    settings.name = "ground";
    settings.domain = domain_.domain();
    dds::Node ground(settings);
    Inbox<std::int64_t> pauses;
    const auto subscription =
        ground.subscribe<messages::msg::VehicleInfo>(messages::topics::kVehicleInfo, [&](const auto& info) {
          if (info.paused()) pauses.put(info.stamp_ns());
        });
    auto clock = ground.publish(messages::topics::kSimulationClock);
    messages::msg::SimulationClock clock_message;
    for (const std::int64_t until_ns : {100'000'000, 150'000'000}) {
      clock_message.advance_to_ns(until_ns);
      ASSERT_TRUE(eventually(
          [&] {
            clock.publish(clock_message);
            return pauses.wait(
                [&](const auto& stamps) { return !stamps.empty() && stamps.back() == until_ns; }, 200ms);
          },
          kStuck))
          << plant->errors();
      for (const std::int64_t stamp_ns : pauses.items()) EXPECT_LE(stamp_ns, until_ns);
    }
  }
  EXPECT_EQ(plant->wait(kStuck), 1);
  EXPECT_NE(plant->errors().find("lockstep: ground is silent: no simulation_clock has come for 0.5 s"),
            std::string::npos)
      << plant->errors();
}

TEST_F(LockstepServices, RunWithoutAGroundTool) {
  const auto mocap = start("swiftlet-mocap");
  const auto control = start("swiftlet-control");
  const auto plant = start("swiftlet-plant");
  EXPECT_TRUE(
      eventually([&] { return control->errors().find("mocap available") != std::string::npos; }, kStuck))
      << plant->errors() << control->errors() << mocap->errors();
  plant->signal(SIGTERM);
  EXPECT_EQ(plant->wait(kStuck), 0) << plant->errors();
}

TEST(LockstepOptions, ConflictingOnesAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& program, const std::vector<std::string>& words) {
    const ProgramResult result = run_program(program, words, folder.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    return result.errors;
  };
  EXPECT_NE(refused("swiftlet", {"fly", "--trace"}).find("--trace"), std::string::npos);
  EXPECT_NE(refused("swiftlet", {"fly", "--clock", "sundial"}).find("--clock"), std::string::npos);
  EXPECT_NE(refused("swiftlet-plant", {"--paused"}).find("--paused"), std::string::npos);
  EXPECT_NE(refused("swiftlet-plant", {"--patience", "1"}).find("--patience"), std::string::npos);
}

}  // namespace
}  // namespace swiftlet::tests

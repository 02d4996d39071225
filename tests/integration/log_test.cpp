// Recorded messages from end to end: `swiftlet record` beside a flying vehicle.
#include <csignal>
#include <filesystem>
#include <map>
#include <string>
#include <sys/mount.h>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/mocap/room.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/mcap/attached_file.hpp"
#include "swiftlet/record/mcap/reader.hpp"
#include "tests/integration/recorded_log.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/program.hpp"
#include "tests/support/shifted_clock.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;

std::size_t gaps_in(const std::vector<mcap::Message>& messages) {
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < messages.size(); ++i)
    gaps += messages[i].sequence - messages[i - 1].sequence - 1;
  return gaps;
}

void expect_holds_what_control_flies_with(const mcap::Reader& file) {
  const auto vehicle = mcap::attached_file(file, "kl1", "vehicle.yaml");
  ASSERT_TRUE(vehicle) << "control tells its files";
  EXPECT_NE(vehicle->find("name: kaylion"), std::string::npos);
  EXPECT_TRUE(mcap::attached_file(file, "kl1", "control.yaml"));
}

// What the recorder says that it has lost of a topic on the way to it, on a busy computer.
std::size_t lost_of(const mcap::Reader& file, const std::string& topic) {
  for (const mcap::Metadata& one : file.metadata()) {
    const auto lost = one.values.find("lost " + topic);
    if (one.name == "swiftlet/counts" && lost != one.values.end()) return std::stoul(lost->second);
  }
  return 0;
}

// Two recorders at once: `swiftlet record`, and that of a flight with processes that run already. A recorder receives
// no request that was sent before both processes knew each other: requests are repeated until it has some.
TEST_F(Log, HoldsEveryMessageOfAFlight) {
  const std::string file = path("flight.mcap");
  const auto recorder = start("swiftlet", {"record", "--output", file, "--json"});
  ASSERT_TRUE(eventually([&] { return recorder->errors().find("recording to") != std::string::npos; }));
  const auto plant = start("swiftlet-plant", {"--clock", "lockstep", "--speed", "5"});
  const auto mocap = start("swiftlet-mocap", {"--clock", "lockstep"});
  const auto control = start("swiftlet-control", {"--clock", "lockstep"});
  const std::string mission = folder_.write("hop.yaml", kHopMission);
  const auto request = [&](std::vector<std::string> words) {
    return run_program("swiftlet", on_this_domain(std::move(words)), folder_.path(), kStuck).exit_code;
  };
  ASSERT_TRUE(eventually([&] {
    request({"disarm"});
    request({"mission", "upload", mission});
    const auto heads = heads_of(mcap::Reader(file, mcap::Access::kScanned));
    return heads.count("/kl1/command") == 1 && heads.count("/kl1/mission") == 1;
  }));
  const ProgramResult flight = run_program(
      "swiftlet",
      on_this_domain({"fly", mission, "--attach", "--skip-check", "--record", path("record"), "--json"}),
      folder_.path(), kStuck);
  ASSERT_EQ(flight.exit_code, 0) << flight.errors;
  recorder->signal(SIGINT);
  ASSERT_EQ(recorder->wait(kStuck), 0) << recorder->errors();
  const json result = json::parse(recorder->output());
  EXPECT_EQ(result.at("dropped"), 0);

  const mcap::Reader recorded(file, mcap::Access::kScanned);
  EXPECT_TRUE(recorded.finished());
  EXPECT_TRUE(recorded.damages().empty());
  const auto heads = heads_of(recorded);
  std::uint64_t received = 0;  // without those that the recorder adds
  for (const auto& [id, count] : recorded.statistics().messages_by_channel) {
    if (recorded.schema_of(recorded.channels().at(id))->name.rfind("swiftlet_msgs/", 0) == 0)
      received += count;
  }
  EXPECT_EQ(received, result.at("messages"));
  for (const char* topic :
       {"/tf", "/kl1/pose", "/kl1/path", "/kl1/odometry", "/kl1/imu_flu", "/kl1/battery_state", "/kl1/log"})
    EXPECT_EQ(heads.count(topic), 1U) << topic;
  for (const char* topic :
       {"/kl1/imu", "/kl1/actuator_command", "/kl1/mocap_pose", "/kl1/battery", "/kl1/estimate",
        "/kl1/reference", "/kl1/ground_truth", "/kl1/control_status", "/kl1/mission_status",
        "/kl1/vehicle_info", "/kl1/command", "/kl1/mission", "/kl1/command_ack"})
    ASSERT_EQ(heads.count(topic), 1U) << topic;
  const mcap::Reader of_flight(path("record/flight.mcap"), mcap::Access::kScanned);
  EXPECT_TRUE(of_flight.finished());
  EXPECT_EQ(gaps_in(heads_of(of_flight).at("/kl1/imu")), lost_of(of_flight, "/kl1/imu"));
  EXPECT_TRUE(mcap::attached_file(of_flight, "kl1", "mission.yaml"));
  EXPECT_EQ(of_flight.attachments().size(), 3U) << "each once";
  expect_holds_what_control_flies_with(of_flight);
  expect_holds_what_control_flies_with(recorded);
  const auto& imu = heads.at("/kl1/imu");
  EXPECT_EQ(gaps_in(imu), lost_of(recorded, "/kl1/imu")) << recorder->output();
  EXPECT_GT(imu.size(), 2000U);
  for (const mcap::Message& sample : imu) {
    EXPECT_GE(sample.log_time_ns, sample.publish_time_ns);
    EXPECT_LE(sample.log_time_ns, sample.publish_time_ns + 30 * math::kSecond_ns) << "another clock";
  }
}

void expect_describes_the_flight(const mcap::Reader& recorded) {
  EXPECT_TRUE(recorded.finished());
  EXPECT_TRUE(recorded.damages().empty());
  std::map<std::string, std::map<std::string, std::string>> metadata;
  for (const mcap::Metadata& one : recorded.metadata()) metadata[one.name] = one.values;
  const auto& about = metadata.at("swiftlet/flight");
  EXPECT_EQ(about.at("missions"), "hop");
  EXPECT_EQ(about.at("seed"), "5");
  EXPECT_EQ(about.at("control"), "motor_lag");
  EXPECT_EQ(metadata.at("swiftlet/recorder").at("time"), "vehicle");
  EXPECT_EQ(recorded.attachments().size(), 4U);
}

class RecordOfAFlight : public Log {
 protected:
  // Its results are those of the flight, without the report beside it.
  void expect_results(const json& flight) const {
    fs::copy_file(path("record/flight.mcap"), path("alone.mcap"));
    const ProgramResult report =
        run_program("swiftlet", {"report", path("alone.mcap"), "--json"}, folder_.path());
    ASSERT_EQ(report.exit_code, 0) << report.errors;
    const json reported = json::parse(report.output).at("flights").at(0);
    EXPECT_EQ(reported.at("report").at("completed"), true);
    EXPECT_EQ(reported.at("report").at("mission"), "hop");
    for (const char* figure : {"rms_3d_m", "peak_3d_m", "duration_s"}) {
      EXPECT_EQ(reported.at("report").at(figure), flight.at(figure)) << figure;
    }
    EXPECT_TRUE(reported.at("settings").contains("control.position.x.omega_n"));
  }
  // The same flight in one process has the same messages.
  void expect_same_messages_in_one_process() const {
    const ProgramResult simulated = run_program(
        "swiftlet", {"sim", "fly", folder_.path() / "hop.yaml", "--seed", "5", "--record", path("sim")},
        folder_.path(), kStuck);
    ASSERT_EQ(simulated.exit_code, 0) << simulated.errors;
    std::vector<std::string> diff = {"log", "diff", path("sim/flight.mcap"), path("record/flight.mcap"),
                                     "--json"};
    for (const char* topic : {"actuator_command", "mocap_pose", "ground_truth", "estimate", "reference",
                              "battery", "rotor_speeds", "imu"})
      diff.insert(diff.end(), {"--topic", std::string("/kl1/") + topic});
    const ProgramResult difference = run_program("swiftlet", diff, folder_.path());
    ASSERT_EQ(difference.exit_code, 0) << difference.errors;
    for (const json& topic : json::parse(difference.output).at("topics")) {
      EXPECT_GT(topic.at("compared"), 10) << topic;
      for (const auto& [name, signal] : topic.at("signals").items())
        EXPECT_EQ(signal.at("max"), 0.0) << topic.at("topic") << " " << name;
    }
    EXPECT_GT(heads_of(mcap::Reader(path("sim/flight.mcap"))).at("/kl1/log").size(), 5U);
  }
};

TEST_F(RecordOfAFlight, HoldsItsMessages) {
  const ProgramResult flight =
      run_program("swiftlet",
                  {"fly", folder_.write("hop.yaml", kHopMission), "--clock", "lockstep", "--seed", "5",
                   "--domain", std::to_string(lock_.domain()), "--record", path("record"), "--json"},
                  folder_.path(), kStuck);
  ASSERT_EQ(flight.exit_code, 0) << flight.errors;
  const mcap::Reader recorded(path("record/flight.mcap"), mcap::Access::kScanned);
  expect_describes_the_flight(recorded);
  // In simulated time.
  const auto heads = heads_of(recorded);
  const double simulated_s = json::parse(flight.output).at("simulated_s");
  EXPECT_NEAR(static_cast<double>(recorded.statistics().end_ns) * 1e-9, simulated_s, 1.0);
  EXPECT_GT(heads.at("/kl1/imu").size(), 1000U);
  EXPECT_EQ(heads.count("/kl1/mission"), 1U);
  expect_results(json::parse(flight.output));
  // The same controller does the same with its sensors, another one does not.
  const auto replay = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"log", "replay", path("record/flight.mcap"), "--into-control", "--json"});
    return run_program("swiftlet", more, folder_.path(), kStuck);
  };
  const ProgramResult same = replay({"--tolerance", "0"});
  EXPECT_EQ(same.exit_code, 0) << same.output << same.errors;
  const json compared = json::parse(same.output);
  EXPECT_EQ(compared.at("control"), "recorded");
  EXPECT_EQ(compared.at("other_answers"), 0);
  EXPECT_EQ(compared.at("requests"), 3);
  EXPECT_GT(compared.at("compared"), 1000);
  EXPECT_EQ(compared.at("signals").at("throttle").at("max"), 0.0);
  expect_same_messages_in_one_process();
  const ProgramResult other = replay({"--control", "paper"});
  EXPECT_EQ(other.exit_code, 1) << other.output << other.errors;
  EXPECT_GT(json::parse(other.output).at("signals").at("throttle").at("max"), 0.01);
}

// GIVEN a body that is calibrated by hand WHEN a recorded flight is given THEN what it tells is added to the room file.
TEST_F(Log, TellsHowABodySitsOnItsVehicle) {
  const ProgramResult flight = run_program(
      "swiftlet", {"sim", "fly", "calibration", "--record", path("record")}, folder_.path(), kStuck);
  ASSERT_EQ(flight.exit_code, 0) << flight.errors;
  const std::string room = folder_.write(
      "room.yaml",
      "source: natnet\nframe: yup\nvehicles:\n"
      "  kl1: {body: drone, lever_arm_frd_m: [0.02, 0, 0.01], misalignment_rad: [0, 0, 0.1]}\n");
  const auto calibrate = [&](const std::string& log) {
    return run_program("swiftlet", {"mocap", "calibrate", "--room", room, "--log", log}, folder_.path(),
                       kStuck);
  };
  const ProgramResult result = calibrate(path("record/flight.mcap"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  // The simulated body is misaligned by 1.75 mrad, and its origin is the centre of mass.
  const mocap::Room written = mocap::load_room(room);
  const mocap::VehicleBody& body = *mocap::find(written, "kl1");
  EXPECT_NEAR((body.misalignment - Eigen::Vector3d(0, 0, 0.1)).norm(), 1.75e-3, 1e-3) << result.output;
  EXPECT_LT((body.lever_arm_frd - Eigen::Vector3d(0.02, 0, 0.01)).norm(), 5e-3) << result.output;
  EXPECT_EQ(calibrate(path("record")).exit_code, 0) << "the folder stands for its flight.mcap";
}

TEST_F(Log, OfAKilledRecorderIsReadableUpToTheLastSecond) {
  start_vehicle();
  const std::string file = path("killed.mcap");
  const auto recorder = start("swiftlet", {"record", "--output", file});
  ASSERT_TRUE(grows_to(file, 100'000));
  const std::int64_t killed_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                     std::chrono::system_clock::now().time_since_epoch())
                                     .count();
  recorder->signal(SIGKILL);
  recorder->wait(kStuck);
  const mcap::Reader recorded(file);
  EXPECT_FALSE(recorded.finished());
  EXPECT_GT(recorded.statistics().end_ns, killed_ns - math::kSecond_ns);
  EXPECT_EQ(gaps_in(heads_of(recorded).at("/kl1/imu")), 0U);
}

// A limit of the file's size, and a small file system.
// The recorder's clock is set back by two hours while it records. By the wall clock: it is that of the file.
TEST_F(Log, GoesOnEvenlyWhenTheSystemClockIsSet) {
  start_vehicle();
  const std::string file = path("flight.mcap");
  std::unique_ptr<Program> recorder;
  {
    const ShiftedClock clock(folder_.path() / "shift", {0, 0.0, -7200.0, 1.0});
    recorder = start("swiftlet", {"record", "--output", file});
  }
  const auto recorded_s = [&] {
    if (!fs::exists(file)) return 0.0;
    const mcap::Statistics statistics = mcap::Reader(file, mcap::Access::kScanned).statistics();
    return 1e-9 * static_cast<double>(statistics.end_ns - statistics.start_ns);
  };
  ASSERT_TRUE(eventually([&] { return recorded_s() > 2.0; }));
  recorder->signal(SIGINT);
  ASSERT_EQ(recorder->wait(kStuck), 0) << recorder->errors();
  EXPECT_LT(recorded_s(), 600.0);
}

TEST_F(Log, OnAFullDiskEndsWithAnErrorAndIsReadable) {
  start_vehicle();
  const std::string file = path("full.mcap");
  const ProgramResult recorder =
      run_program("/usr/bin/prlimit",
                  on_this_domain({"--fsize=400000", program_file("swiftlet"), "record", "--output", file}),
                  folder_.path(), kStuck);
  EXPECT_EQ(recorder.exit_code, 1);
  EXPECT_NE(recorder.errors.find(file + ": cannot be written: File too large"), std::string::npos)
      << recorder.errors;
  {
    const mcap::Reader recorded(file);
    EXPECT_TRUE(recorded.damages().empty());
    EXPECT_GT(recorded.statistics().message_count, 500U);
  }
  EXPECT_FALSE(vehicle_->exit_code().has_value());

  const std::string small = path("small");
  fs::create_directory(small);
  if (::mount("tmpfs", small.c_str(), "tmpfs", 0, "size=600k") != 0)
    GTEST_SKIP() << "mounting a small file system needs root";
  const ProgramResult on_small = run_program(
      "swiftlet", on_this_domain({"record", "--output", small + "/full.mcap"}), folder_.path(), kStuck);
  EXPECT_EQ(on_small.exit_code, 1);
  EXPECT_NE(on_small.errors.find("full.mcap: cannot be written: No space left on device"), std::string::npos)
      << on_small.errors;
  {
    const mcap::Reader recorded(small + "/full.mcap");
    EXPECT_TRUE(recorded.damages().empty());
    EXPECT_GT(recorded.statistics().message_count, 500U);
  }
  EXPECT_FALSE(vehicle_->exit_code().has_value());
  EXPECT_EQ(::umount(small.c_str()), 0);
}

TEST_F(Log, OfAllVehiclesHasThoseThatAppearLater) {
  const std::string file = path("all.mcap");
  const auto recorder = start("swiftlet", {"record", "--all", "--output", file, "--compression", "lz4"});
  ASSERT_TRUE(eventually([&] { return fs::exists(file); }));
  const auto first = start("swiftlet-plant", {"--vehicle-name", "a1,a2", "--speed", "4"});
  ASSERT_TRUE(grows_to(file, 50'000));
  const auto second = start("swiftlet-plant", {"--vehicle-name", "b1", "--speed", "4"});
  ASSERT_TRUE(eventually([&] {
    const auto heads = heads_of(mcap::Reader(file));
    return heads.count("/b1/imu") == 1 && heads.count("/b1/vehicle_info") == 1;
  }));
  const std::uintmax_t before = fs::file_size(file);
  ASSERT_TRUE(grows_to(file, before + 50'000));
  recorder->signal(SIGTERM);
  ASSERT_EQ(recorder->wait(kStuck), 0) << recorder->errors();
  const auto heads = heads_of(mcap::Reader(file));
  for (const char* topic : {"/a1/imu", "/a2/imu", "/b1/imu", "/b1/vehicle_info"})
    EXPECT_EQ(heads.count(topic), 1U) << topic;
}

TEST_F(Log, IsRefusedWhereAFileWouldBeLost) {
  const std::string file = folder_.write("kept.mcap", "dear");
  const ProgramResult refused =
      run_program("swiftlet", on_this_domain({"record", "--output", file}), folder_.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("exists; choose another name, or add --replace"), std::string::npos)
      << refused.errors;
  EXPECT_EQ(fs::file_size(file), 4U);
  const ProgramResult nobody =
      run_program("swiftlet", on_this_domain({"record", "--output", file, "--replace", "--duration", "0.1"}),
                  folder_.path());
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_NE(nobody.errors.find("no message was received in domain"), std::string::npos) << nobody.errors;
}

}  // namespace
}  // namespace swiftlet::tests

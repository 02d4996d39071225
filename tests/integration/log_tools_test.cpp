// `swiftlet log` on a recorded file.
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/math/time.hpp"
#include "swiftlet/record/mcap/reader.hpp"
#include "tests/integration/recorded_log.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"

namespace swiftlet::tests {
namespace {

using nlohmann::json;

class LogTools : public Log {
 protected:
  // Two seconds in which the vehicle lives through eight.
  void SetUp() override {
    start_vehicle();
    const ProgramResult recorded = run_program(
        "swiftlet", on_this_domain({"record", "--output", file_, "--duration", "2"}), folder_.path());
    ASSERT_EQ(recorded.exit_code, 0) << recorded.errors;
  }
  ProgramResult log(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "log");
    return run_program("swiftlet", arguments, folder_.path());
  }
  json info(const std::string& file) const {
    const ProgramResult result = log({"info", file, "--check", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
    return json::parse(result.output);
  }
  void expect_info_and_topics() const;
  void expect_the_same_after_cut_and_merge() const;
  void expect_table_of_values() const;
  void expect_repair() const;

  const std::string file_ = path("flight.mcap");
};

void LogTools::expect_info_and_topics() const {
  const json whole = info(file_);
  EXPECT_TRUE(whole.at("finished"));
  EXPECT_EQ(whole.at("profile"), "ros2");
  EXPECT_EQ(whole.at("metadata").at("swiftlet/counts").at("dropped"), "0");
  EXPECT_NEAR(whole.at("duration_s").get<double>(), 2.0, 0.7);
  const ProgramResult topics = log({"ls", file_});
  EXPECT_NE(topics.output.find("swiftlet_msgs/msg/RotorSpeeds"), std::string::npos) << topics.output;
  const ProgramResult signals = log({"ls", file_, "/kl1/battery"});
  EXPECT_EQ(signals.output, "stamp_ns\nsequence_number\nvoltage_v\ncurrent_a\nstate_of_charge\n");
  const ProgramResult unknown = log({"ls", file_, "/kl1/batery"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.errors.find("/kl1/batery: is not in the file, which has /kl1/actuator_command, "),
            std::string::npos)
      << unknown.errors;
}

void LogTools::expect_the_same_after_cut_and_merge() const {
  const json whole = info(file_);
  ASSERT_EQ(log({"cut", file_, "--to", "0.5", "-o", path("a.mcap")}).exit_code, 0);
  ASSERT_EQ(log({"cut", file_, "--from", "0.5", "-o", path("b.mcap")}).exit_code, 0);
  ASSERT_EQ(log({"merge", path("b.mcap"), path("a.mcap"), "-o", path("merged.mcap")}).exit_code, 0);
  EXPECT_EQ(info(path("merged.mcap")).at("topics"), whole.at("topics"));
  EXPECT_EQ(info(path("merged.mcap")).at("end_ns"), whole.at("end_ns"));
  const auto before = heads_of(mcap::Reader(file_));
  const auto after = heads_of(mcap::Reader(path("merged.mcap")));
  for (const auto& [topic, messages] : before) {
    ASSERT_EQ(after.at(topic).size(), messages.size()) << topic;
    EXPECT_EQ(after.at(topic).back().sequence, messages.back().sequence) << topic;
  }
  const ProgramResult imu = log({"cut", file_, "--topic", "/kl1/imu", "-o", path("imu.mcap")});
  EXPECT_EQ(imu.exit_code, 0) << imu.errors;
  EXPECT_EQ(heads_of(mcap::Reader(path("imu.mcap"))).size(), 1U);
  EXPECT_EQ(log({"cut", file_, "-o", file_, "--replace"}).exit_code, 2);
  EXPECT_EQ(log({"cut", file_, "--from", "2", "--to", "0.5", "-o", path("none.mcap")}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("none.mcap")));
}

void LogTools::expect_table_of_values() const {
  const ProgramResult written = log({"csv", file_, "/kl1/imu", "-o", path("imu.csv")});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  std::ifstream table(path("imu.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line.substr(0, 81),
            "log_time_ns,publish_time_ns,stamp_ns,sequence_number,specific_force_frd[0],specif");
  std::size_t rows = 0;
  double z_sum = 0.0;
  for (; std::getline(table, line); ++rows) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i <= 6; ++i) std::getline(cells, cell, ',');
    z_sum += std::stod(cell);
  }
  EXPECT_EQ(rows, heads_of(mcap::Reader(file_)).at("/kl1/imu").size());
  EXPECT_NEAR(z_sum / static_cast<double>(rows), -9.81, 0.3);  // specific force along z at rest
}

void LogTools::expect_repair() const {
  std::uint64_t offset = 0;
  std::uint64_t messages = 0;
  {
    const mcap::Reader whole(file_);
    ASSERT_GE(whole.chunks().size(), 3U);
    const auto least = std::min_element(
        whole.chunks().begin(), whole.chunks().end(),
        [](const auto& a, const auto& b) { return a.uncompressed_size < b.uncompressed_size; });
    offset = least->offset + least->length - 10;
    messages = whole.statistics().message_count;
  }
  std::fstream bytes(file_, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(offset));
  bytes.write("spoiled", 7);
  bytes.close();
  EXPECT_EQ(log({"info", file_, "--check"}).exit_code, 1);
  const ProgramResult repaired = log({"repair", file_, "-o", path("repaired.mcap")});
  EXPECT_EQ(repaired.exit_code, 0);
  EXPECT_NE(repaired.errors.find("chunk"), std::string::npos) << repaired.errors;
  const json after = info(path("repaired.mcap"));
  EXPECT_LT(after.at("messages"), messages);
  EXPECT_GT(after.at("messages"), messages / 3) << "the other chunks";
}

TEST_F(LogTools, ShowCutMergeTabulateReplayAndRepairAFile) {
  expect_info_and_topics();
  expect_the_same_after_cut_and_merge();
  expect_table_of_values();

  const ProgramResult refused =
      run_program("swiftlet", on_this_domain({"log", "replay", file_}), folder_.path());
  EXPECT_EQ(refused.exit_code, 1) << "a vehicle of this name lives";
  vehicle_.reset();
  const std::string again = path("again.mcap");
  const auto recorder = start("swiftlet", {"record", "--output", again});
  ASSERT_TRUE(eventually([&] { return recorder->errors().find("recording to") != std::string::npos; }));
  const ProgramResult replayed = run_program(
      "swiftlet", on_this_domain({"log", "replay", file_, "--speed", "2", "--json"}), folder_.path(), kStuck);
  ASSERT_EQ(replayed.exit_code, 0) << replayed.errors;
  const auto before = heads_of(mcap::Reader(file_));
  const auto& imu = before.at("/kl1/imu");
  ASSERT_TRUE(eventually([&] {
    const auto written = heads_of(mcap::Reader(again, mcap::Access::kScanned));
    return written.count("/kl1/imu") == 1 && written.at("/kl1/imu").size() == imu.size();
  }));
  recorder->signal(SIGINT);
  ASSERT_EQ(recorder->wait(kStuck), 0) << recorder->errors();
  const auto after = heads_of(mcap::Reader(again));
  const auto length_ns = [](const std::vector<mcap::Message>& messages) {
    return messages.back().log_time_ns - messages.front().log_time_ns;
  };
  // At twice the speed: a busy machine delays the last samples, and hurries none.
  const auto recorded_ns = static_cast<double>(length_ns(imu));
  const auto replayed_ns = static_cast<double>(length_ns(after.at("/kl1/imu")));
  EXPECT_GT(replayed_ns, 0.5 * recorded_ns - 0.2 * math::kSecond_ns);
  EXPECT_LT(replayed_ns, 0.9 * recorded_ns);
  const ProgramResult difference = log({"diff", file_, again, "--topic", "/kl1/imu", "--json"});
  EXPECT_EQ(json::parse(difference.output).at("equal"), true) << difference.output;
  expect_repair();
}

}  // namespace
}  // namespace swiftlet::tests

// Flight records from end to end: folders, full disks, and flights flown again.
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/program.hpp"
#include "tests/support/program_path.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;

class Record : public testing::Test {
 protected:
  ProgramResult fly(const std::string& mission, std::vector<std::string> more) const {
    more.insert(more.begin(), {"sim", "fly", mission, "--json"});
    return run_program("swiftlet", more, folder_.path());
  }
  fs::path record() const { return folder_.path() / "record"; }

  TemporaryFolder folder_;
  const std::string hop_ = folder_.write("hop.yaml", kHopMission);
};

TEST_F(Record, OfAnEarlierFlightIsKeptOrReplacedWhole) {
  const ProgramResult first = fly(hop_, {"--record", record(), "--trace"});
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const auto written = fs::last_write_time(record() / "report.json");

  const ProgramResult second = fly(hop_, {"--record", record()});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.errors.find("the folder holds another record (process "), std::string::npos)
      << second.errors;
  EXPECT_NE(second.errors.find("add --replace"), std::string::npos) << second.errors;
  EXPECT_EQ(fs::last_write_time(record() / "report.json"), written);
  EXPECT_TRUE(fs::exists(record() / "trace.csv"));

  const ProgramResult third = fly(hop_, {"--record", record(), "--replace"});
  EXPECT_EQ(third.exit_code, 0) << third.errors;
  EXPECT_FALSE(fs::exists(record() / "trace.csv")) << "of the first flight";
  EXPECT_NE(fs::last_write_time(record() / "report.json"), written);
}

TEST_F(Record, FlightsBegunTogetherHaveRecordsOfTheirOwn) {
  fs::current_path(folder_.path());
  constexpr std::size_t kFlights = 4;
  std::vector<std::unique_ptr<Program>> flights;
  for (std::size_t i = 0; i < kFlights; ++i)
    flights.push_back(std::make_unique<Program>(
        "swiftlet", std::vector<std::string>{"sim", "fly", hop_, "--json", "--seed", std::to_string(i)},
        folder_.path()));
  std::set<std::string> folders;
  for (std::size_t i = 0; i < kFlights; ++i) {
    ASSERT_EQ(flights[i]->wait(kStuck), 0) << flights[i]->errors();
    const std::string folder = json::parse(flights[i]->output()).at("record_dir");
    std::ifstream in(fs::path(folder) / "report.json");
    EXPECT_EQ(json::parse(in).at("seed"), i);
    folders.insert(folder);
  }
  EXPECT_EQ(folders.size(), kFlights);
}

// Files larger than the limit cannot be written, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_;
};

TEST_F(Record, ThatDoesNotFitLeavesTheResultOfTheFlight) {
  ProgramResult result;
  {
    const FileSizeLimit full(1'000'000);
    result = fly(hop_, {"--record", record(), "--trace"});
  }
  EXPECT_EQ(result.exit_code, 1);
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_LT(report.at("rms_3d_m"), 0.02);
  EXPECT_TRUE(report.contains("record_fault"));
  EXPECT_NE(result.errors.find("is incomplete: "), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("cannot be written: File too large"), std::string::npos) << result.errors;
  std::ifstream file(record() / "report.json");
  EXPECT_EQ(json::parse(file).at("record_fault"), report.at("record_fault"));
  const ProgramResult page = run_program("swiftlet", {"report", record()}, folder_.path());
  EXPECT_EQ(page.exit_code, 0) << "of what was recorded: " << page.errors;
}

TEST_F(Record, OfABatchWithATruncatedPictureIsAFailure) {
  fs::create_directory(folder_.path() / "bin");
  write_program(folder_.path() / "bin" / "gnuplot", "printf '\\211PNG half of it' > 0");
  const ProgramPath path(folder_.path() / "bin");
  const std::string vary = folder_.write(
      "vary.yaml",
      "parameters:\n"
      "  vehicle.mass: {distribution: uniform, min: 0.95, max: 1.05, unit: nominal, source: estimate}\n");
  const ProgramResult result =
      run_program("swiftlet", {"sim", "batch", hop_, "--dispersion", vary, "--runs", "2", "--out", record()},
                  folder_.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("2 completed, 0 failed"), std::string::npos) << result.output;
  EXPECT_NE(result.errors.find("is incomplete: no picture was drawn: gnuplot wrote a truncated file"),
            std::string::npos)
      << result.errors;
  EXPECT_FALSE(fs::exists(record() / "batch.png"));
  EXPECT_TRUE(fs::exists(record() / "batch.csv"));
}

TEST_F(Record, CanBeFlownAgain) {
  const ProgramResult first = fly(hop_, {"--record", record()});
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const std::string table = folder_.path() / "hop.csv";
  const ProgramResult written =
      run_program("swiftlet", {"log", "csv", record(), "-o", table}, folder_.path());
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const ProgramResult again = fly(table, {"--record", folder_.path() / "again"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_NE(again.errors.find("the reference of a recorded flight between take-off and landing"),
            std::string::npos)
      << again.errors;
  const ProgramResult checked = run_program("swiftlet", {"mission", "check", table}, folder_.path());
  EXPECT_EQ(checked.exit_code, 0) << checked.errors << checked.output;
}

// GIVEN a flight WHEN its file is read alone, without the report beside it THEN all figures are those of the flight.
TEST_F(Record, HasTheSameFiguresWhereverTheyArePrinted) {
  const ProgramResult flight = fly(hop_, {"--record", record()});
  ASSERT_EQ(flight.exit_code, 0) << flight.errors;
  const json flown = json::parse(flight.output);
  const fs::path alone = folder_.path() / "alone.mcap";
  fs::copy_file(record() / "flight.mcap", alone);

  const ProgramResult read = run_program("swiftlet", {"report", alone, "--json"}, folder_.path());
  ASSERT_EQ(read.exit_code, 0) << read.errors;
  const json report = json::parse(read.output).at("flights").at(0).at("report");
  for (const char* const key : {"completed", "rms_3d_m", "peak_3d_m", "matched_samples", "duration_s"})
    EXPECT_EQ(report.at(key), flown.at(key)) << key;

  char rms[32], peak[32];
  std::snprintf(rms, sizeof rms, "%.2f", 1e3 * flown.at("rms_3d_m").get<double>());
  std::snprintf(peak, sizeof peak, "%.2f", 1e3 * flown.at("peak_3d_m").get<double>());
  const ProgramResult table = run_program("swiftlet", {"report", alone}, folder_.path());
  EXPECT_NE(table.output.find(std::string("RMS 3-D, mm   ") + rms), std::string::npos) << table.output;
  EXPECT_NE(table.output.find(std::string("peak 3-D, mm  ") + peak), std::string::npos) << table.output;
  ASSERT_EQ(run_program("swiftlet", {"report", record()}, folder_.path()).exit_code, 0);
  std::ostringstream page;
  page << std::ifstream(record() / "flight.html").rdbuf();
  EXPECT_NE(page.str().find(std::string(">") + rms + " mm</td>"), std::string::npos) << rms;
  EXPECT_NE(page.str().find(std::string(">") + peak + " mm</td>"), std::string::npos) << peak;
}

// One table, with its frame in the header or by the option, means the same to every command.
TEST_F(Record, OfATableIsTheSameInBothFrames) {
  const auto rms_of = [&](const std::string& name, const std::string& text, std::vector<std::string> more) {
    more.insert(more.end(), {"--record", folder_.path() / name});
    const ProgramResult result = fly(folder_.write(name + ".csv", text), more);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.exit_code == 0 ? json::parse(result.output).at("rms_3d_m").get<double>() : -1.0;
  };
  const std::string rows = "\n0,0,0,-1\n3,0.5,-0.2,-1.2\n6,0,0,-1\n";
  const double ned = rms_of("ned", "t [s],x_ned [m],y_ned [m],z_ned [m]" + rows, {});
  const double option = rms_of("option", "t [s],x [m],y [m],z [m]" + rows, {"--frame", "ned"});
  const double enu =
      rms_of("enu", "t [s],y_enu [m],x_enu [m],z_enu [cm]\n0,0,0,100\n3,0.5,-0.2,120\n6,0,0,100\n", {});
  EXPECT_EQ(ned, option);
  EXPECT_NEAR(ned, enu, 1e-9);
  const ProgramResult unclear = fly(folder_.path() / "option.csv", {});
  EXPECT_EQ(unclear.exit_code, 2);
  EXPECT_NE(unclear.errors.find("option.csv:1: header: names no frame"), std::string::npos) << unclear.errors;
}

}  // namespace
}  // namespace swiftlet::tests

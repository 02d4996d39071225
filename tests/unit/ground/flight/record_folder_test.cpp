#include "swiftlet/ground/flight/record_folder.hpp"

#include <atomic>
#include <memory>
#include <set>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::record_folder_test {

namespace fs = std::filesystem;

class RecordFolderTest : public testing::Test {
 protected:
  static std::string refusal(const fs::path& folder, ExistingRecord existing) {
    try {
      const RecordFolder made(folder, existing);
      return "none";
    } catch (const io::InputError& error) {
      return error.what();
    }
  }
  void make_record(const std::string& name) {
    const RecordFolder made(folder_ / name, ExistingRecord::kRefused);
    temporary_.write(name + "/report.json", "{}");
    temporary_.write(name + "/sensors.csv", "t [s]\n");
    temporary_.write(name + "/swiftlet-plant.log", "");
    temporary_.write(name + "/mission.plan", "");
  }

  tests::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(RecordFolderTest, OneOfManyFlightsThatBeginTogetherGetsTheFolder) {
  constexpr int kFlights = 16;
  std::atomic<int> made{0}, refused{0};
  std::vector<std::unique_ptr<RecordFolder>> folders(kFlights);
  std::vector<std::thread> flights;
  for (int i = 0; i < kFlights; ++i) {
    flights.emplace_back([&, i] {
      try {
        folders[static_cast<std::size_t>(i)] =
            std::make_unique<RecordFolder>(folder_ / "record", ExistingRecord::kRefused);
        ++made;
      } catch (const io::InputError&) {
        ++refused;
      }
    });
  }
  for (std::thread& flight : flights) flight.join();
  EXPECT_EQ(made, 1);
  EXPECT_EQ(refused, kFlights - 1);
}

TEST_F(RecordFolderTest, FlightsOfOneSecondGetFoldersOfTheirOwn) {
  constexpr int kFlights = 16;
  std::vector<std::unique_ptr<RecordFolder>> folders(kFlights);
  std::vector<std::thread> flights;
  for (std::unique_ptr<RecordFolder>& folder : folders) {
    flights.emplace_back([&] {
      folder = std::make_unique<RecordFolder>(folder_ / "20261121-093909-square", ExistingRecord::kNumbered);
    });
  }
  for (std::thread& flight : flights) flight.join();
  std::set<fs::path> paths;
  for (const auto& folder : folders) paths.insert(folder->path());
  EXPECT_EQ(paths.size(), static_cast<std::size_t>(kFlights));
  EXPECT_EQ(paths.count(folder_ / "20261121-093909-square"), 1U);
  EXPECT_EQ(paths.count(folder_ / "20261121-093909-square-16"), 1U);
}

TEST_F(RecordFolderTest, RefusesTheRecordOfAnEarlierFlight) {
  make_record("first");
  const std::string sentence = refusal(folder_ / "first", ExistingRecord::kRefused);
  EXPECT_EQ(sentence.find("--record " + (folder_ / "first").string() +
                          ": the folder holds another record (process " + std::to_string(getpid()) + " on "),
            0U)
      << sentence;
  EXPECT_NE(sentence.find("; choose another folder, or add --replace to delete that record first"),
            std::string::npos)
      << sentence;
  EXPECT_TRUE(fs::exists(folder_ / "first/sensors.csv"));
}

TEST_F(RecordFolderTest, ReplacesARecordWhole) {
  make_record("first");
  fs::create_directory(folder_ / "first/kl1");
  temporary_.write("first/kl1/flight.csv", "");
  const RecordFolder made(folder_ / "first", ExistingRecord::kReplaced);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "first"))
    EXPECT_EQ(entry.path().filename(), "record.txt");
}

TEST_F(RecordFolderTest, ReplacesARecordWithUnfinishedFiles) {
  make_record("first");
  for (const char* name : {"flight.csv.part", "report.json.part", "flight.png.part"})
    temporary_.write(std::string("first/") + name, "");
  const RecordFolder made(folder_ / "first", ExistingRecord::kReplaced);
  EXPECT_FALSE(fs::exists(folder_ / "first/flight.csv.part"));
}

TEST_F(RecordFolderTest, DeletesNothingButRecords) {
  make_record("first");
  temporary_.write("first/thesis.tex", "");
  EXPECT_EQ(refusal(folder_ / "first", ExistingRecord::kReplaced),
            "--record " + (folder_ / "first").string() +
                ": --replace deletes records only, and no flight writes thesis.tex; choose another folder");
  EXPECT_EQ(
      refusal(folder_ / "first", ExistingRecord::kRefused),
      "--record " + (folder_ / "first").string() + ": the folder is not empty; choose a new or an empty one");
  EXPECT_TRUE(fs::exists(folder_ / "first/report.json"));
}

TEST_F(RecordFolderTest, DoesNotReplaceAFolderOfSettings) {
  fs::create_directory(folder_ / "mine");
  for (const char* name : {"mission.yaml", "vehicle.yaml", "control.yaml"})
    temporary_.write(std::string("mine/") + name, "");
  EXPECT_EQ(refusal(folder_ / "mine", ExistingRecord::kReplaced),
            "--record " + (folder_ / "mine").string() +
                ": --replace deletes records only, and the folder holds none (no record.txt or report.json); "
                "choose another folder");
  EXPECT_TRUE(fs::exists(folder_ / "mine/mission.yaml"));
}

TEST_F(RecordFolderTest, DoesNotReplaceTheFilesThatTheFlightReads) {
  make_record("first");
  const fs::path mission = folder_ / "first/mission.yaml";
  temporary_.write("first/mission.yaml", "");
  try {
    const RecordFolder made(folder_ / "first", ExistingRecord::kReplaced, "--record", {mission});
    FAIL() << "the record was replaced";
  } catch (const io::InputError& error) {
    EXPECT_EQ(error.what(), "--record " + (folder_ / "first").string() + ": --replace would delete " +
                                mission.string() + ", which this flight reads; choose another folder");
  }
  EXPECT_TRUE(fs::exists(mission));
}

TEST_F(RecordFolderTest, DoesNotReplaceTheRecordOfAFlightInProgress) {
  const RecordFolder flying(folder_ / "first", ExistingRecord::kRefused);
  const std::string sentence = refusal(folder_ / "first", ExistingRecord::kReplaced);
  EXPECT_NE(sentence.find(": a flight is writing it (process "), std::string::npos) << sentence;
  EXPECT_TRUE(fs::exists(folder_ / "first/record.txt"));
}

TEST_F(RecordFolderTest, LeavesNoTraceOfAFlightThatWroteNothing) {
  EXPECT_EQ(refusal(folder_ / "new", ExistingRecord::kRefused), "none");
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(refusal(folder_ / "empty", ExistingRecord::kRefused), "none");
  EXPECT_TRUE(fs::is_empty(folder_ / "empty"));
}

TEST_F(RecordFolderTest, CannotBeMadeInAFile) {
  temporary_.write("file", "");
  EXPECT_NE(refusal(folder_ / "file/record", ExistingRecord::kRefused).find("cannot be created"),
            std::string::npos);
}

TEST(RecordSpace, IsCheckedBeforeTheFlight) {
  EXPECT_EQ(space_fault(3'000'000, 3'000'000), "");
  EXPECT_EQ(space_fault(12'000'000, 3'000'000),
            "the record needs about 12.0 MB, 3.0 MB are free; choose a folder on another disk, or make room");
  const tests::TemporaryFolder folder;
  EXPECT_NO_THROW(require_space(folder.path() / "not" / "yet", 1));
  EXPECT_THROW(require_space(folder.path() / "not" / "yet", std::uintmax_t{1} << 60), io::InputError);
  EXPECT_FALSE(fs::exists(folder.path() / "not"));
}

TEST(RecordSpace, GrowsWithDurationRateAndFiles) {
  LaunchConfiguration plan;
  plan.planned_duration_s = 60.0;
  plan.simulation.imu.rate_hz = 500;
  const std::uintmax_t messages = plan.record_bytes();
  plan.trace = true;
  const std::uintmax_t traced = plan.record_bytes();
  EXPECT_GT(traced, messages + std::uintmax_t{60} * 500 * 200);
  plan.simulation.imu.rate_hz = 1000;
  EXPECT_GT(plan.record_bytes(), traced + std::uintmax_t{60} * 500 * 200);
}

}  // namespace swiftlet::ground::record_folder_test

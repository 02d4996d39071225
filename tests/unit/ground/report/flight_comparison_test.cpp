#include "swiftlet/ground/report/flight_comparison.hpp"

#include <gtest/gtest.h>

#include "swiftlet/ground/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::flight_comparison_test {

using Settings = std::vector<std::pair<std::string, std::string>>;

TEST(FlatYaml, EverySettingHasItsKey) {
  EXPECT_EQ(runtime::flatten_yaml("name: n\nposition:\n  x: {omega_n: 2.0, k: [1, 2]}\n"
                                  "items:\n  - {kind: land}\n  - {kind: wait, at: ~}\n",
                                  "a.yaml"),
            (Settings{{"name", "n"},
                      {"position.x.omega_n", "2.0"},
                      {"position.x.k", "[1, 2]"},
                      {"items[0].kind", "land"},
                      {"items[1].kind", "wait"},
                      {"items[1].at", ""}}));
}

TEST(FlatYaml, NamesTheLineOfInvalidYaml) {
  try {
    runtime::flatten_yaml("a: 1\nb: [1, 2\n", "a.yaml");
    FAIL();
  } catch (const runtime::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("a.yaml:"), std::string::npos) << error.what();
  }
}

class FlightComparison : public testing::Test {
 protected:
  std::filesystem::path flight(const std::string& name, const std::string& rms, const std::string& omega_n) {
    std::filesystem::path folder = folder_.path() / name;
    std::filesystem::create_directory(folder);
    folder_.write(name + "/report.json",
                  R"({"completed": true, "mission": "square", "rms_3d_m": )" + rms + "}");
    folder_.write(name + "/control.yaml", "position: {omega_n: " + omega_n + ", zeta: 1}\n");
    return folder;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(FlightComparison, ShowsFiguresAndGainsOfOneFlight) {
  const std::string table = comparison_table({load_recorded_flight(flight("a", "0.001234", "2.0"))});
  EXPECT_NE(table.find("RMS 3-D, mm   1.23\n"), std::string::npos) << table;
  EXPECT_NE(table.find("control.position.omega_n  2.0\n"), std::string::npos) << table;
  EXPECT_NE(table.find("peak 3-D, mm  -\n"), std::string::npos) << "not in the report";
}

TEST_F(FlightComparison, ShowsTheDifferencesOfSeveralFlights) {
  const std::vector<RecordedFlight> flights = {load_recorded_flight(flight("a", "0.001", "2.0")),
                                               load_recorded_flight(flight("b", "0.010", "1.3"))};
  const std::string table = comparison_table(flights);
  EXPECT_NE(table.find("control.position.omega_n  2.0  1.3\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("zeta"), std::string::npos) << "equal in both";
  EXPECT_EQ(comparison_json(flights)["differ"], nlohmann::ordered_json::array({"control.position.omega_n"}));
}

TEST_F(FlightComparison, NewestFlightHasTheLatestReport) {
  const std::filesystem::path older = flight("b", "0.001", "2.0");
  const std::filesystem::path newer = flight("a", "0.001", "2.0");
  std::filesystem::last_write_time(
      older / "report.json", std::filesystem::last_write_time(newer / "report.json") - std::chrono::hours(1));
  EXPECT_EQ(newest_record(folder_.path()), newer);
}

TEST_F(FlightComparison, FindsTheFlightsOfSeveralVehicles) {
  const std::filesystem::path single = flight("a", "0.001", "2.0");
  std::filesystem::create_directory(folder_.path() / "b");
  const std::filesystem::path kl2 = flight("b/kl2", "0.002", "2.0");
  const std::filesystem::path kl1 = flight("b/kl1", "0.003", "2.0");
  std::filesystem::last_write_time(
      single / "report.json", std::filesystem::last_write_time(kl1 / "report.json") - std::chrono::hours(1));
  EXPECT_EQ(newest_record(folder_.path()), folder_.path() / "b");
  EXPECT_EQ(flights_of(folder_.path() / "b"), (std::vector<std::filesystem::path>{kl1, kl2}));
  EXPECT_EQ(flights_of(single), std::vector<std::filesystem::path>{single});
  folder_.write("b/kl1/report.json", R"({"completed": true, "vehicle_name": "kl1"})");
  EXPECT_EQ(load_recorded_flight(kl1).name, "b/kl1");
}

TEST_F(FlightComparison, SaysThatAFlightHasNotEnded) {
  folder_.write("record.txt", "process 12 on lab, 2026-11-21 09:39:09\n");
  try {
    load_recorded_flight(folder_.path());
    FAIL() << "a flight without a report was loaded";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), folder_.path().string() +
                                ": contains no report.json, its flight still flies or was killed (record.txt "
                                "names its process)");
  }
}

TEST_F(FlightComparison, RefusesFoldersWithoutAFlight) {
  EXPECT_THROW(load_recorded_flight(folder_.path()), InputError);
  EXPECT_THROW(newest_record(folder_.path() / "none"), InputError);
  EXPECT_THROW(flights_of(folder_.path()), InputError);
  folder_.write("report.json", "{\"completed\": tr");
  EXPECT_THROW(load_recorded_flight(folder_.path()), runtime::ConfigError);
}

TEST_F(FlightComparison, CountsTheVehiclesOfARecord) {
  for (const char* const vehicle : {"kl10", "kl2", "kl1"}) flight(vehicle, "0.001", "2.0");
  std::vector<std::string> names;
  for (const std::filesystem::path& one : flights_of(folder_.path())) names.push_back(one.filename());
  EXPECT_EQ(names, (std::vector<std::string>{"kl1", "kl2", "kl10"}));
}

}  // namespace swiftlet::ground::flight_comparison_test

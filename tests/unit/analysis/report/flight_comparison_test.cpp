#include "swiftlet/analysis/report/flight_comparison.hpp"

#include <array>
#include <chrono>
#include <filesystem>

#include <gtest/gtest.h>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::analysis::flight_comparison_test {

using Settings = std::vector<std::pair<std::string, std::string>>;

TEST(FlatYaml, EverySettingHasItsKey) {
  EXPECT_EQ(io::flatten_yaml("name: n\nposition:\n  x: {omega_n: 2.0, k: [1, 2]}\n"
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
    io::flatten_yaml("a: 1\nb: [1, 2\n", "a.yaml");
    FAIL();
  } catch (const io::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("a.yaml:"), std::string::npos) << error.what();
  }
}

class FlightComparison : public testing::Test {
 protected:
  // A flight as load_record() returns it.
  static RecordedFlight flight(const std::string& name, double rms_m, const std::string& omega_n) {
    RecordedFlight flight;
    flight.name = name;
    flight.report = {{"completed", true}, {"mission", "square"}, {"rms_3d_m", rms_m}};
    flight.settings = {{"control.position.omega_n", omega_n}, {"control.position.zeta", "1"}};
    return flight;
  }
  // An MCAP file with a message of each vehicle.
  void write_file(const std::string& name, const std::vector<std::string>& vehicles,
                  const std::string& topic = "empty") {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    mcap::Writer file(folder_.path() / name, {});
    const auto schema = file.add_schema("swiftlet_msgs/msg/Empty", "ros2msg", "int64 stamp_ns\n");
    const std::array<std::uint8_t, 12> payload = {0, 1};
    for (const std::string& vehicle : vehicles)
      file.write(mcap::Message{file.add_channel("/" + vehicle + "/" + topic, schema, "cdr", {}),
                               1,
                               1,
                               1,
                               {payload.data(), payload.size()}});
    file.close();
  }
  static std::vector<std::string> names(const std::vector<RecordedFlight>& flights) {
    std::vector<std::string> names;
    for (const RecordedFlight& flight : flights) names.push_back(flight.name);
    return names;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(FlightComparison, ShowsFiguresAndGainsOfOneFlight) {
  const std::string table = comparison_table({flight("a", 0.001234, "2.0")});
  EXPECT_NE(table.find("RMS 3-D, mm   1.23\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("control.position.omega_n"), std::string::npos) << table;
  EXPECT_NE(settings_table({flight("a", 0.001234, "2.0")}).find("control.position.omega_n  2.0\n"),
            std::string::npos);
  EXPECT_NE(table.find("peak 3-D, mm  -\n"), std::string::npos) << "not in the report";
}

TEST_F(FlightComparison, ShowsTheDifferencesOfSeveralFlights) {
  const std::vector<RecordedFlight> flights = {flight("a", 0.001, "2.0"), flight("b", 0.010, "1.3")};
  EXPECT_NE(comparison_table(flights).find("\n1 setting differs (--settings)\n"), std::string::npos);
  const std::string table = settings_table(flights);
  EXPECT_NE(table.find("control.position.omega_n  2.0  1.3\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("zeta"), std::string::npos) << "equal in both";
  EXPECT_EQ(comparison_json(flights)["differ"], nlohmann::ordered_json::array({"control.position.omega_n"}));
}

TEST_F(FlightComparison, NewestRecordHasTheLatestFile) {
  write_file("b/flight.mcap", {"kl1"});
  write_file("a/flight.mcap", {"kl1"});
  std::filesystem::create_directory(folder_.path() / "c");
  const auto time = std::filesystem::last_write_time(folder_.path() / "a/flight.mcap");
  std::filesystem::last_write_time(folder_.path() / "b/flight.mcap", time - std::chrono::hours(1));
  EXPECT_EQ(newest_record(folder_.path()), folder_.path() / "a");
}

TEST_F(FlightComparison, FindsTheFlightsOfSeveralVehicles) {
  write_file("b/flight.mcap", {"kl10", "kl2", "kl1"});
  std::filesystem::create_directory(folder_.path() / "b/kl2");
  folder_.write("b/kl2/report.json", R"({"completed": false, "reason": "late", "tolerance_m": 0.1})");
  EXPECT_EQ(names(load_record(folder_.path() / "b")), (std::vector<std::string>{"b/kl1", "b/kl2", "b/kl10"}));
  EXPECT_EQ(names(load_record(folder_.path() / "b/flight.mcap")).size(), 3U);
  const std::vector<RecordedFlight> kl2 = load_record(folder_.path() / "b/kl2/");
  ASSERT_EQ(names(kl2), std::vector<std::string>{"b/kl2"});
  EXPECT_EQ(kl2[0].report["reason"], "late") << "as it was judged";
  EXPECT_EQ(kl2[0].report["tolerance_m"], 0.1);
}

TEST_F(FlightComparison, OfAFileSaysThatNoMissionWasFlown) {
  write_file("hover.mcap", {"kl1"});
  const std::vector<RecordedFlight> flights = load_record(folder_.path() / "hover.mcap");
  ASSERT_EQ(names(flights), std::vector<std::string>{"hover.mcap"});
  EXPECT_EQ(flights[0].report["reason"], "no mission was flown");
  EXPECT_EQ(flights[0].report["level"], "") << "no command";
}

TEST_F(FlightComparison, ShowsTheLevelOfEachFlight) {
  write_file("a.mcap", {"kl1"}, "rates_setpoint");
  write_file("b.mcap", {"kl1"}, "attitude_setpoint");
  std::vector<RecordedFlight> flights = load_record(folder_.path() / "a.mcap");
  flights.push_back(load_record(folder_.path() / "b.mcap").front());
  EXPECT_NE(comparison_table(flights).find("level         rates   attitude\n"), std::string::npos)
      << comparison_table(flights);
}

TEST_F(FlightComparison, RefusesWhatHoldsNoFlight) {
  EXPECT_THROW(load_record(folder_.path()), io::ConfigError);
  EXPECT_THROW(load_record(folder_.path() / "none"), io::ConfigError);
  EXPECT_THROW(newest_record(folder_.path() / "none"), io::InputError);
  write_file("flight.mcap", {"kl1"});
  folder_.write("report.json", "{\"completed\": tr");
  EXPECT_THROW(load_record(folder_.path()), io::ConfigError);
}

}  // namespace swiftlet::analysis::flight_comparison_test

// `swiftlet identify flight` from end to end: reads a flight record, writes a vehicle file that other
// commands read.
#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

// A fit takes seconds, and ten times as long with sanitizers.
constexpr std::chrono::seconds kFitTimeout{120};

class IdentifyFlight : public testing::Test {
 protected:
  ProgramResult run(std::vector<std::string> words) const {
    return run_program("swiftlet", std::move(words), folder_.path(), kFitTimeout);
  }
  std::string in_folder(const char* name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(IdentifyFlight, WritesAVehicleFileFromARecord) {
  const ProgramResult flight =
      run({"sim", "fly", "identification", "--record", in_folder("first"), "--json"});
  ASSERT_EQ(flight.exit_code, 0) << flight.errors;
  const ProgramResult result = run({"identify", "flight", in_folder("first"), "--out", in_folder("mine.yaml"),
                                    "--report", in_folder("report.html"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const nlohmann::json report = nlohmann::json::parse(result.output);
  EXPECT_EQ(report["vehicle"], "mine");
  EXPECT_EQ(report["source"], "measured");
  EXPECT_EQ(report["prediction"].size(), 4U);
  const plant::Vehicle found = io::load_vehicle(in_folder("mine.yaml"));
  EXPECT_NEAR(found.rotor.thrust / 3.7901e-8, 1.0, 0.01);
  EXPECT_NEAR(found.motor.time_constant_s / 0.0821, 1.0, 0.001);
  EXPECT_GE(io::load_vehicle_uncertainty(in_folder("mine.yaml")).parameters.size(), 5U);
  std::ostringstream page;
  page << std::ifstream(in_folder("report.html")).rdbuf();
  EXPECT_NE(page.str().find("<figure data-panel="), std::string::npos);
  EXPECT_EQ(page.str().find("<script src"), std::string::npos);

  const ProgramResult gains =
      run({"gains", "--vehicle", in_folder("mine.yaml"), "--samples", "50", "--json"});
  ASSERT_EQ(gains.exit_code, 0) << gains.errors;
  const nlohmann::json margins = nlohmann::json::parse(gains.output);
  EXPECT_EQ(margins["samples"], 50);
  EXPECT_LE(margins["margins"]["roll"]["worst"]["phase_deg"],
            margins["margins"]["roll"]["designed"]["phase_deg"]);

  const ProgramResult batch =
      run({"sim", "batch", "square", "--vehicle", in_folder("mine.yaml"), "--dispersion", "uncertainty",
           "--runs", "10", "--out", in_folder("batch"), "--json"});
  EXPECT_EQ(batch.exit_code, 0) << batch.errors;
}

// Identification uses data received over the network, not internals of the plant.
TEST_F(IdentifyFlight, ReadsTheRecordOfSeparateProcesses) {
  const ProgramResult flight =
      run({"fly", "identification", "--clock", "lockstep", "--record", in_folder("first"), "--json"});
  ASSERT_EQ(flight.exit_code, 0) << flight.errors;
  const ProgramResult result =
      run({"identify", "flight", in_folder("first"), "--out", in_folder("mine.yaml"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NEAR(io::load_vehicle(in_folder("mine.yaml")).motor.time_constant_s / 0.0821, 1.0, 0.001);
}

TEST_F(IdentifyFlight, ReportsWhatALogWithoutPosesDetermines) {
  const std::string log = in_source("tests/data/crazyflie_flight.csv.gz");
  const ProgramResult result = run({"identify", "flight", log, "--base", "crazyflie2", "--out",
                                    in_folder("mine.yaml"), "--report", in_folder("report.html"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const nlohmann::json report = nlohmann::json::parse(result.output);
  EXPECT_EQ(report["source"], "commanded");
  EXPECT_EQ(report["lags"].size(), 3U);
  EXPECT_EQ(report["beside_file"].size(), 4U);
  EXPECT_EQ(report["beside_file"][0]["file"], 0.072);
  EXPECT_EQ(report["horizons"].size(), 20U);
  EXPECT_NE(report["unexcited"].dump().find("does not determine them"), std::string::npos);
  const plant::Vehicle found = io::load_vehicle(in_folder("mine.yaml"));
  EXPECT_EQ(found.mass_kg, 0.027);
  EXPECT_NEAR(found.motor.time_constant_s, 0.065, 0.01);
  std::ostringstream page;
  page << std::ifstream(in_folder("report.html")).rdbuf();
  EXPECT_NE(page.str().find("Comparison with the vehicle file"), std::string::npos);
  EXPECT_NE(page.str().find("Thrust over mass by command"), std::string::npos);
}

TEST_F(IdentifyFlight, RefusesInvalidLogs) {
  const std::string head =
      "t [s],acc_x [g],acc_y [g],acc_z [g],p [rad/s],q [rad/s],r [rad/s],m1 [1],m2 [1],m3 [1],m4 [1]\n";
  std::string still = head;
  for (int i = 0; i < 200; ++i) still += std::to_string(0.01 * i) + ",0,0,1,0,0,0,0,0,0,0\n";
  const ProgramResult rotors_off =
      run({"identify", "flight", folder_.write("still.csv", still), "--base", "kaylion"});
  EXPECT_EQ(rotors_off.exit_code, 2);
  EXPECT_NE(rotors_off.errors.find("still.csv: the rotors never ran"), std::string::npos)
      << rotors_off.errors;
  const ProgramResult no_vehicle = run({"identify", "flight", in_folder("still.csv")});
  EXPECT_EQ(no_vehicle.exit_code, 2);
  EXPECT_NE(no_vehicle.errors.find("--base: is needed: " + in_folder("still.csv")), std::string::npos)
      << no_vehicle.errors;
  const ProgramResult missing = run({"identify", "flight", in_folder("nowhere.csv"), "--base", "kaylion"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.errors.find("nowhere.csv: cannot be read"), std::string::npos) << missing.errors;
  const ProgramResult no_log = run({"identify", "flight", folder_.path()});
  EXPECT_EQ(no_log.exit_code, 2);
  EXPECT_NE(no_log.errors.find(": holds no flight.mcap, is not the record of a flight"), std::string::npos)
      << no_log.errors;
  const ProgramResult unit =
      run({"identify", "flight", folder_.write("unit.csv", "t,acc_x [g]\n0,0\n"), "--base", "kaylion"});
  EXPECT_EQ(unit.exit_code, 2);
  EXPECT_NE(unit.errors.find("has the column t without a unit"), std::string::npos) << unit.errors;
}

}  // namespace
}  // namespace swiftlet::tests

// `swiftlet identify` from end to end: reads bench data, writes a vehicle file that other commands read.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;

class Identify : public testing::Test {
 protected:
  Identify() {
    const ProgramResult result = run({"identify", "simulate", "--vehicle", "kaylion", "--noise", "0.005",
                                      "--seed", "4", "--out", bench().string()});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }

  ProgramResult run(std::vector<std::string> words) const {
    return run_program("swiftlet", std::move(words), folder_.path());
  }
  ProgramResult identify(const fs::path& from) const {
    return run({"identify", from.string(), "--out", vehicle(), "--report", page(), "--json"});
  }
  fs::path bench() const { return folder_.path() / "bench"; }
  std::string vehicle() const { return (folder_.path() / "mine.yaml").string(); }
  std::string page() const { return (folder_.path() / "report.html").string(); }

  void overwrite(const char* name, const std::string& text) const { std::ofstream(bench() / name) << text; }
  // A steady_motor.csv whose speed column is `speed` in every row, or rises if that is empty.
  std::string steady_motor(const std::string& header, const std::string& speed, int rows = 20) const {
    std::string text = header + "\n";
    for (int i = 0; i < rows; ++i)
      text +=
          std::to_string(1.0 + 0.1 * i) + "," + (speed.empty() ? std::to_string(700 + 60 * i) : speed) + "\n";
    return text;
  }
  void expect_refusal(const std::string& sentence) const {
    const ProgramResult result = identify(bench());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_FALSE(fs::exists(vehicle()));
    EXPECT_FALSE(fs::exists(page()));
  }

  TemporaryFolder folder_;
};

TEST_F(Identify, WritesAVehicleThatOtherCommandsRead) {
  const ProgramResult result = identify(bench());
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const nlohmann::json report = nlohmann::json::parse(result.output);
  EXPECT_EQ(report["vehicle"], "mine");
  const plant::Vehicle found = io::load_vehicle(vehicle());
  EXPECT_NEAR(found.motor.k2 / 1.020e-3, 1.0, 0.05);
  EXPECT_NEAR(found.rotor.thrust / 3.7901e-8, 1.0, 0.01);
  EXPECT_EQ(io::load_vehicle_uncertainty(vehicle()).parameters.size(), 11U);
  std::ostringstream text;
  text << std::ifstream(page()).rdbuf();
  EXPECT_NE(text.str().find("Fig. 7:"), std::string::npos);
  EXPECT_EQ(text.str().find("<script src"), std::string::npos);

  const ProgramResult gains = run({"gains", "--vehicle", vehicle(), "--json"});
  EXPECT_EQ(gains.exit_code, 0) << gains.errors;
  EXPECT_EQ(nlohmann::json::parse(gains.output)["vehicle"], "mine");
}

TEST_F(Identify, RefusesAHeaderWithoutAUnit) {
  overwrite("steady_motor.csv", steady_motor("v_a [V],speed", ""));
  expect_refusal(
      "steady_motor.csv:1: header: has the column speed without a unit, must be speed [rad/s], speed [rpm]");
}

TEST_F(Identify, RefusesNaN) {
  overwrite("steady_motor.csv", steady_motor("v_a [V],speed [rad/s]", "nan"));
  expect_refusal("steady_motor.csv:2: speed [rad/s]: is nan, must be a finite number");
}

TEST_F(Identify, RefusesConstantColumns) {
  overwrite("steady_motor.csv", steady_motor("v_a [V],speed [rad/s]", "1500"));
  expect_refusal("steady_motor.csv: speed: is 1500 rad/s in all 20 rows, must vary");
}

TEST_F(Identify, RefusesTooFewRows) {
  overwrite("steady_motor.csv", steady_motor("v_a [V],speed [rad/s]", "", 3));
  expect_refusal("steady_motor.csv: has 3 rows, must have at least 6");
}

TEST_F(Identify, RefusesWrongUnits) {
  std::ostringstream esc;
  esc << std::ifstream(bench() / "esc.csv").rdbuf();
  std::string text = esc.str();
  overwrite("esc.csv", text.replace(text.find("motor_voltage [V]"), 17, "motor_voltage [mV]"));
  const ProgramResult result = identify(bench());  // a thousandth of the voltage cannot hover
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("the identified vehicle cannot fly"), std::string::npos) << result.errors;
  text.replace(text.find("supply_voltage [V]"), 18, "supply_voltage [mV]");
  overwrite("esc.csv", text);
  expect_refusal("esc.csv");
}

TEST_F(Identify, NamesTheLineOfAMissingBase) {
  overwrite("bench.yaml", "name: mine\nbase_vehicle: krazyflie\n");
  expect_refusal("bench.yaml:2: base_vehicle: No vehicle 'krazyflie'. Did you mean 'crazyflie2'?");
  EXPECT_EQ(run({"identify", bench().string(), "--base", "kaylion", "--out", vehicle()}).exit_code, 0);
}

TEST_F(Identify, RefusesToOverwriteItsInputs) {
  const std::string base = (folder_.path() / "base.yaml").string();
  fs::copy_file(in_source("config/vehicles/kaylion.yaml"), base);
  const ProgramResult result = run({"identify", bench().string(), "--base", base, "--out", base});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("--out: " + base + " is also an input file"), std::string::npos)
      << result.errors;
  EXPECT_EQ(io::load_vehicle(base).name, "kaylion");
}

TEST_F(Identify, RefusesInvalidArguments) {
  const ProgramResult missing = identify(folder_.path() / "nowhere");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.errors.find("nowhere: is not a folder"), std::string::npos) << missing.errors;
  EXPECT_EQ(run({"identify"}).exit_code, 2);
  EXPECT_EQ(run({"identify", bench().string()}).exit_code, 2);
  EXPECT_EQ(run({"identify", "simulate", "--noise", "nan", "--out", vehicle()}).exit_code, 2);
}

}  // namespace
}  // namespace swiftlet::tests

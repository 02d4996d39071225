#include "swiftlet/analysis/identify/identification_report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::analysis::identification_report_test {

IdentificationReport report() {
  IdentificationReport out;
  out.bench_folder = "a <bench>";
  out.base_vehicle = "kaylion";
  out.base = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  identification::BenchNoise noise;
  noise.outliers = 0.05;
  out.bench.data = identification::simulate_bench(out.base, noise, 2);
  out.bench.data.propeller = identification::Propeller{0.0275, 1.2};
  for (const char* name : {"mass", "esc", "thrust_torque", "steady_motor", "motor_step", "throttle_thrust",
                           "inertia_roll", "inertia_pitch", "inertia_yaw"}) {
    BenchFile& file = out.bench.files[name];
    file.file = std::string(name) + ".csv";
    for (int line = 2; line < 1000; ++line) file.lines.push_back(line);
  }
  out.found = identification::identify_bench(out.bench.data, out.base);
  return out;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(IdentificationPage, HasThePapersFiguresWithoutExternalResources) {
  const std::string page = identification_page(report()).html();
  for (const char* figure : {"<figcaption>Fig. 2:", "<figcaption>Fig. 3:", "<figcaption>Fig. 4:",
                             "<figcaption>Fig. 6:", "<figcaption>Fig. 7:"})
    EXPECT_EQ(count(page, figure), 1U) << figure;
  // With the step, thrust over throttle, and the residuals of each fit.
  EXPECT_GE(count(page, "<figure data-panel="), 17U);
  for (const char* foreign : {"<script src", "<img", "@import", "url("})
    EXPECT_EQ(count(page, foreign), 0U) << foreign;
  EXPECT_EQ(count(page, "a <bench>"), 0U);
  EXPECT_GT(count(page, "a &lt;bench&gt;"), 0U);
}

TEST(IdentificationJson, ListsEveryParameterWithItsInterval) {
  const IdentificationReport given = report();
  const nlohmann::json out = nlohmann::json::parse(identification_json(given));
  std::size_t in_vehicle = 0;
  for (const auto& parameter : out["parameters"]) {
    EXPECT_LT(parameter["interval_95"][0], parameter["value"]);
    EXPECT_GT(parameter["interval_95"][1], parameter["value"]);
    if (parameter["parameter"] == "motor.k2") {
      ++in_vehicle;
      EXPECT_EQ(parameter["value"], given.found.vehicle.motor.k2);
      EXPECT_EQ(parameter["unit"], "V*s/rad");
    }
  }
  EXPECT_EQ(in_vehicle, 1U);
  const auto& esc = out["experiments"][0];
  EXPECT_EQ(esc["name"], "esc");
  EXPECT_EQ(esc["outlier_lines"].size(), given.found.esc->outliers.size());
  ASSERT_FALSE(given.found.esc->outliers.empty());
  EXPECT_EQ(esc["outlier_lines"][0], static_cast<int>(given.found.esc->outliers[0]) + 2);
}

TEST(IdentificationTable, NamesParametersOutliersAndFindings) {
  const std::string table = identification_table(report());
  for (const char* part : {"motor.k2", "rotor.thrust_coefficient", "motor_step.reading",
                           "outliers, left out, of ", "Eq. (9) fits better", "figure of merit"})
    EXPECT_NE(table.find(part), std::string::npos) << part;
}

}  // namespace swiftlet::analysis::identification_report_test

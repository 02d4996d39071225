#include "swiftlet/analysis/identify/report_page.hpp"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace swiftlet::analysis::report_page_test {

identification::ParameterEstimate estimate(double value, double half_width, bool identifiable = true) {
  return {"inertia.zz", "J_zz", "kg*m^2", value, 0.5 * half_width, half_width, identifiable};
}

std::string shown(double value, double half_width) {
  const EstimateText text = text_of(estimate(value, half_width));
  return text.value + " +- " + text.half_width;
}

TEST(EstimateText, ShowsTwoDigitsOfTheUncertainty) {
  EXPECT_EQ(shown(0.0820999, 2e-5), "0.082100 +- 2.0e-05");
  EXPECT_EQ(shown(3.7899e-8, 6.1e-12), "3.78990e-08 +- 6.1e-12");
  EXPECT_EQ(shown(-0.17238, 0.0023), "-0.1724 +- 0.0023");
  EXPECT_EQ(shown(-4.3e-8, 8.2e-7), "-4e-08 +- 8.2e-07");
  EXPECT_EQ(shown(123.4, 10.0), "123 +- 10");
  EXPECT_EQ(shown(1.5, 0.0), "1.5 +- 0");
}

TEST(EstimateText, HasNoNumberIfItIsNotIdentifiable) {
  const identification::ParameterEstimate unknown = estimate(8.4e-6, 2.6e-6, false);
  EXPECT_EQ(text_of(unknown).value, "-");
  EXPECT_EQ(table_cells(unknown), "           -  -         ");
  const nlohmann::ordered_json json = json_of(unknown);
  for (const char* const key : {"value", "standard_error", "interval_95"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
  pages::Page page("parameters");
  add_estimates(page, {unknown});
  EXPECT_NE(page.html().find(">not identifiable</td>"), std::string::npos);
  EXPECT_EQ(page.html().find("8.4"), std::string::npos);
}

}  // namespace swiftlet::analysis::report_page_test

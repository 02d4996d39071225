#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "tests/unit/fault.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::polynomial_csv_test {

using control::MissionItemKind;
using Eigen::Vector3d;

MissionFile polynomials(const std::string& text) {
  return parse_any_mission_file(text, "p.csv", control::Limits());
}

TEST(PolynomialCsv, ConvertsEnuToNed) {
  const MissionFile file =
      polynomials(kPolynomialHeader + "\n" + polynomial_row(4.0, 0.5, 1.0, 1.5, 0.3) + "\n");
  EXPECT_EQ(file.name, "p");
  ASSERT_EQ(file.mission.items.size(), 3U);
  EXPECT_EQ(file.mission.items[0].kind, MissionItemKind::kTakeoff);
  EXPECT_NEAR(file.mission.items[0].position_ned.z(), -1.5, 1e-9);
  EXPECT_EQ(file.mission.items[1].kind, MissionItemKind::kTrajectory);
  EXPECT_EQ(file.mission.items[1].segment_count, 1U);
  EXPECT_EQ(file.mission.items[2].kind, MissionItemKind::kLand);
  const control::PolynomialSegment& segment = file.mission.segments.front();
  const control::Reference start = at_path_start(file);
  EXPECT_LT((start.position_ned - Vector3d(0, 0.5, -1.5)).norm(), 1e-6);
  EXPECT_NEAR(start.yaw_rad, M_PI / 2 - 0.3, 1e-6);
  EXPECT_LT((control::evaluate(segment, 4.0).position_ned - Vector3d(0, 1.5, -1.5)).norm(), 1e-3);
  EXPECT_TRUE(assumes(file, "ENU"));
  EXPECT_TRUE(assumes(file, "above the ground: the lowest point is 1.50 m"));
  EXPECT_TRUE(assumes(file, "take-off to 1.50 m and a landing are added"));
}

TEST(PolynomialCsv, RaisesALowPathToTheHoverHeight) {
  const MissionFile file = polynomials(kPolynomialHeader + "\n" + polynomial_row(4.0, 0.5, 1.0, 0.1));
  EXPECT_NEAR(at_path_start(file).position_ned.z(), -1.0, 1e-9);
  EXPECT_TRUE(assumes(file, "raised by 0.90 m"));
}

TEST(PolynomialCsv, ReadsACrazyswarmFile) {
  const MissionFile file = load_mission_file(kData + "crazyswarm_figure8.csv", control::Limits());
  EXPECT_EQ(file.name, "crazyswarm_figure8");
  EXPECT_EQ(file.mission.segments.size(), 10U);
  const control::Reference end =
      control::evaluate(file.mission.segments.back(), file.mission.segments.back().duration_s);
  EXPECT_LT((end.position_ned - Vector3d(0, 0, -1)).norm(), 1e-3);
  EXPECT_TRUE(control::check(file.mission, control::Limits()).accepted);
}

std::string replaced(const std::string& text, std::size_t column, const std::string& value) {
  std::size_t begin = 0;
  for (; column > 0; --column) begin = text.find(',', begin) + 1;
  const std::size_t end = text.find(',', begin);
  return text.substr(0, begin) + value + (end == std::string::npos ? "" : text.substr(end));
}
const std::string kRow = polynomial_row(4.0, 0.0, 1.0, 1.0);

class BadPolynomialCsv : public testing::TestWithParam<tests::Fault> {};
TEST_P(BadPolynomialCsv, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { polynomials(GetParam().text); }), GetParam().sentence);
}

std::string repeated_hover(int rows) {
  std::string text = kPolynomialHeader + "\n";
  for (int i = 0; i < rows; ++i) text += polynomial_row(0.5, 0.0, 0.0, 1.0) + "\n";
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    , BadPolynomialCsv,
    testing::Values(
        tests::Fault{"another_header", "duration,x\n1,2\n",
                     "p.csv:1: header: is duration,x, must be " + kPolynomialHeader},
        tests::Fault{"no_rows", kPolynomialHeader + "\n",
                     "p.csv: has 0 rows behind the header, must have at least 1"},
        tests::Fault{"missing_column", kPolynomialHeader + "\n" + kRow.substr(0, kRow.rfind(',')) + "\n",
                     "p.csv:2: has 32 fields, must have 33: " + kPolynomialHeader},
        tests::Fault{"extra_column", kPolynomialHeader + "\n" + kRow + "\n" + kRow + ",1\n",
                     "p.csv:3: has 34 fields, must have 33: " + kPolynomialHeader},
        tests::Fault{"two_trailing_commas", kPolynomialHeader + "\n" + kRow + ",,\n",
                     "p.csv:2: has 34 fields, must have 33: " + kPolynomialHeader},
        tests::Fault{"nan", kPolynomialHeader + "\n" + replaced(kRow, 4, "nan"),
                     "p.csv:2: x^3: is nan, must be a finite number"},
        tests::Fault{"infinity", kPolynomialHeader + "\n" + replaced(kRow, 32, "-inf"),
                     "p.csv:2: yaw^7: is -inf, must be a finite number"},
        tests::Fault{"word", kPolynomialHeader + "\n" + replaced(kRow, 9, "north"),
                     "p.csv:2: y^0: is north, must be a finite number"},
        tests::Fault{"zero_duration", kPolynomialHeader + "\n" + replaced(kRow, 0, "0"),
                     "p.csv:2: duration: is 0, must be above 0 and at most 3600 s"},
        tests::Fault{"duration_above_limit", kPolynomialHeader + "\n" + replaced(kRow, 0, "3600.1"),
                     "p.csv:2: duration: is 3600.1, must be above 0 and at most 3600 s"},
        tests::Fault{"too_many_segments", repeated_hover(1025),
                     "p.csv:1026: duration: is segment 1025, at most 1024 fit"},
        tests::Fault{"outside_the_fence", kPolynomialHeader + "\n" + polynomial_row(9.0, 0.0, 3.01, 1.0),
                     "p.csv:2: segment 1 in ENU: x is 3.010 m, outside the fence of -3.000 to 3.000 m"},
        tests::Fault{"too_fast", kPolynomialHeader + "\n" + polynomial_row(1.8, 0.0, 2.0, 1.0),
                     "p.csv:2: segment 1 in ENU reaches 2.08 m/s, the limit is 2.00 m/s; slower by 1.05: "
                     "--time-scale 1.05"},
        tests::Fault{
            "discontinuous",
            kPolynomialHeader + "\n" + polynomial_row(4.0, 0.0, 1.0, 1.0) + "\n" +
                polynomial_row(4.0, 1.1, 1.0, 1.0),
            "p.csv:3: segment 2 in ENU does not start where the previous one ends: 0.100 m and 0.000 m/s "
            "apart"},
        tests::Fault{"starts_in_motion", kPolynomialHeader + "\n" + replaced(kRow, 2, "0.5"),
                     "p.csv:2: segment 1 in ENU starts at 0.50 m/s, must start at rest"}),
    tests::name_of);

TEST(PolynomialCsv, AcceptsTheMaximumOfSegments) {
  EXPECT_EQ(polynomials(repeated_hover(1024)).mission.segments.size(), 1024U);
}

}  // namespace swiftlet::io::polynomial_csv_test

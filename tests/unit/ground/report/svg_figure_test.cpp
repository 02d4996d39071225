#include "swiftlet/ground/report/svg_figure.hpp"

#include <cmath>
#include <regex>

#include <gtest/gtest.h>

namespace swiftlet::ground {
namespace {

Figure line(double x_scale, double y_scale) {
  Figure figure;
  figure.title = "a < b & c";
  figure.x_label = "speed (rad/s)";
  figure.y_label = "thrust (N)";
  FigureSeries series{"readings", Mark::kDots, "#1f6fb4", {}};
  for (int i = 0; i <= 10; ++i) series.points.push_back({x_scale * i, y_scale * i * i});
  figure.series = {series};
  return figure;
}

std::vector<double> all_x(const std::string& drawn) {
  std::vector<double> out;
  const std::regex dot("M([-0-9.]+) ([-0-9.]+)h0");
  for (auto it = std::sregex_iterator(drawn.begin(), drawn.end(), dot); it != std::sregex_iterator(); ++it)
    out.push_back(std::stod((*it)[1]));
  return out;
}

TEST(SvgFigure, PlacesPointsInProportion) {
  const std::vector<double> x = all_x(svg(line(1.0, 1.0)));
  ASSERT_EQ(x.size(), 11U);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) EXPECT_NEAR(x[i + 1] - x[i], x[i] - x[i - 1], 0.11);
  EXPECT_GT(x.front(), 70.0);
  EXPECT_LT(x.back(), 630.0);
}

TEST(SvgFigure, NamesThePowerOfTenOfItsTicks) {
  const std::string drawn = svg(line(1e6, 1e-7));
  EXPECT_NE(drawn.find(">6</tspan>"), std::string::npos);
  EXPECT_NE(drawn.find(">-6</tspan>"), std::string::npos) << drawn;
  EXPECT_EQ(svg(line(1.0, 1.0)).find("tspan"), std::string::npos);
}

TEST(SvgFigure, PlacesTheLegendInAFreeCorner) {
  const std::regex box(
      "<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"[0-9.]+\" height=\"[0-9.]+\" fill=\"#fff\"");
  std::smatch rising;
  std::smatch falling;
  const std::string up = svg(line(1.0, 1.0));
  const std::string down = svg(line(1.0, -1.0));
  ASSERT_TRUE(std::regex_search(up, rising, box));
  ASSERT_TRUE(std::regex_search(down, falling, box));
  EXPECT_LT(std::stod(rising[1]), 100.0);  // a rising curve leaves the top left free
  EXPECT_GT(std::stod(falling[1]) + std::stod(falling[2]), 400.0);
}

TEST(SvgFigure, EscapesText) {
  EXPECT_NE(svg(line(1.0, 1.0)).find("<title>a &lt; b &amp; c</title>"), std::string::npos);
}

TEST(SvgFigure, DrawsDataWithoutExtent) {
  Figure figure = line(0.0, 0.0);
  EXPECT_EQ(svg(figure).find("nan"), std::string::npos);
  figure.series.clear();
  EXPECT_EQ(svg(figure).find("nan"), std::string::npos);
  EXPECT_EQ(svg(figure).find("inf"), std::string::npos);
}

}  // namespace
}  // namespace swiftlet::ground

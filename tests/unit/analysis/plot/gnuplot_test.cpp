#include "swiftlet/analysis/plot/gnuplot.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "swiftlet/io/command_line/child_process.hpp"
#include "tests/support/program_path.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::plot::gnuplot_test {

namespace fs = std::filesystem;

// What gnuplot would interpret elsewhere: quotes, enhanced text, macros, backquotes, formats.
const std::string kTricky =
    R"(it's "quoted" {/Bold a_b^c} @GPVAL_TERM &{y} `touch oh_no` \n \ %g $1 <b> & ~)";

Figure with(Style style, const std::vector<Point>& points) {
  Figure figure = one_panel("a < b & c", "speed (rad/s)", "thrust (N)");
  figure.panels[0].series = {{style, Colour::kBlue, "", points}};
  return figure;
}

Figure parabola(double x_scale, double y_scale) {
  std::vector<Point> points;
  for (int i = 0; i <= 10; ++i) points.push_back({x_scale * i, y_scale * i * i});
  return with(Style::kDots, points);
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// The picture as SVG, which holds places and texts that a test can read.
std::string svg(const Figure& figure) {
  const tests::TemporaryFolder folder;
  std::string script = gnuplot_script(figure, "picture.svg");
  const std::size_t from = script.find("set terminal");
  const std::size_t to = script.find("set multiplot");
  script.replace(from, script.find('\n', to) - from,
                 "set terminal svg dynamic font 'sans-serif,13' noenhanced size " +
                     std::to_string(figure.width) + "," + std::to_string(figure.height) +
                     "\nset output 'picture.svg'\nset multiplot");
  folder.write("script", script);
  io::ChildProcess process(
      {"gnuplot", io::find_program("gnuplot"), {"script"}, folder.path() / "log", folder.path()});
  EXPECT_TRUE(process.wait(std::chrono::seconds(30)));
  return text_of(folder.path() / "picture.svg");
}

// Where dots and texts are, px.
std::vector<Point> places(const std::string& drawn, const std::string& pattern) {
  std::vector<Point> out;
  const std::regex place(pattern);
  for (auto it = std::sregex_iterator(drawn.begin(), drawn.end(), place); it != std::sregex_iterator(); ++it)
    out.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  return out;
}
std::vector<Point> dots(const std::string& drawn) {
  return places(drawn, "#gpPt6' transform='translate\\(([0-9.]+),([0-9.]+)\\)");
}
std::vector<Point> texts(const std::string& drawn, const std::string& text) {
  return places(drawn, "translate\\(([0-9.]+),([0-9.]+)\\)[^>]*>\\s*<text>" + text + "</text>");
}

class GnuplotTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(io::find_program("gnuplot").empty()) << "install the packages of packages.txt";
  }
  tests::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(GnuplotTest, WritesTheUnitOfALongLabelBelowItAndItsPowerInTheUnit) {
  Figure figure = parabola(1e-3, 1.0);
  figure.panels[0].x.label = "simulation.imu.accelerometer_noise_m_s2_per_sqrt_hz (m/s^2/sqrt(Hz))";
  const std::string drawn = svg(figure);
  EXPECT_NE(drawn.find("<text>simulation.imu.accelerometer_noise_m_s2_per_sqrt_hz</text>"),
            std::string::npos);
  EXPECT_NE(drawn.find("<text>(10\u207b\u00b3 m/s^2/sqrt(Hz))</text>"), std::string::npos);
}

TEST_F(GnuplotTest, DrawsTextsAsTheyAre) {
  Figure figure = parabola(1.0, 1.0);
  Panel& panel = figure.panels[0];
  panel.title = panel.x.label = panel.y.label = panel.series[0].label = kTricky;
  panel.labels = {{{5.0, 50.0}, kTricky}};
  panel.x.names = {"it's {a_b^c} @GPVAL_TERM `y` \\n %g %", "roll"};  // gnuplot cuts longer ones off
  const std::string drawn = svg(figure);
  std::string escaped;
  for (const char c : kTricky) escaped += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  std::size_t count = 0;
  for (std::size_t at = drawn.find(escaped); at != std::string::npos; at = drawn.find(escaped, at + 1))
    ++count;
  EXPECT_EQ(count, 5U) << "title, two axes, legend and label\n" << drawn;
  EXPECT_NE(drawn.find("<text>it's {a_b^c} @GPVAL_TERM `y` \\n %g %</text>"), std::string::npos) << drawn;
  EXPECT_EQ(texts(drawn, "roll").size(), 1U);
  EXPECT_EQ(texts(drawn, "2").size(), 0U) << "names are in place of numbers";
}

TEST_F(GnuplotTest, DrawsAHeadlineAsItIs) {
  Figure figure = parabola(1.0, 1.0);
  figure.title = kTricky + "\n\t\x7f; set output";
  const std::string script = gnuplot_script(figure, "it's.png");
  EXPECT_NE(script.find("set output 'it''s.png'\n"), std::string::npos);
  EXPECT_NE(
      script.find(
          "title 'it''s \"quoted\" {/Bold a_b^c} @GPVAL_TERM &{y} `touch oh_no` \\n \\ %g $1 <b> & ~   ; "
          "set output' font"),
      std::string::npos)
      << script;
  EXPECT_EQ(draw_png(figure, folder_ / "it's.png"), "");
  EXPECT_TRUE(fs::exists(folder_ / "it's.png"));
}

TEST_F(GnuplotTest, PlacesPointsInProportion) {
  const std::vector<Point> at = dots(svg(parabola(1.0, 1.0)));
  ASSERT_EQ(at.size(), 11U);
  for (std::size_t i = 1; i < 10; ++i) {
    EXPECT_NEAR(at[i + 1].x - at[i].x, at[1].x - at[0].x, 0.11);
    EXPECT_NEAR((at[i].y - at[0].y) / (at[10].y - at[0].y), 0.01 * static_cast<double>(i * i), 0.001);
  }
  EXPECT_GT(at[0].x, 50.0);
  EXPECT_LT(at[10].x, 640.0);
}

TEST_F(GnuplotTest, PlacesPointsOnALogarithmicAxis) {
  Figure figure = with(Style::kDots, {{0.01, 1.0}, {0.1, 2.0}, {1.0, 3.0}, {0.0, 4.0}});
  figure.panels[0].x.logarithmic = true;
  const std::vector<Point> at = dots(svg(figure));
  ASSERT_EQ(at.size(), 3U) << "a logarithmic axis has no 0";
  EXPECT_NEAR(at[2].x - at[1].x, at[1].x - at[0].x, 0.11);
}

TEST_F(GnuplotTest, ReversesAnAxis) {
  Figure figure = parabola(1.0, 1.0);
  figure.panels[0].y.reversed = true;
  const std::vector<Point> at = dots(svg(figure));
  ASSERT_EQ(at.size(), 11U);
  EXPECT_GT(at[10].y, at[0].y);
}

TEST_F(GnuplotTest, GivesEqualAxesTheSameScale) {
  Figure figure = with(Style::kDots, {{0.0, 0.0}, {1.0, 0.0}, {0.0, 2.0}});
  figure.panels[0].equal = true;
  const std::vector<Point> at = dots(svg(figure));
  ASSERT_EQ(at.size(), 3U);
  EXPECT_NEAR(at[0].y - at[2].y, 2.0 * (at[1].x - at[0].x), 0.5);
}

TEST_F(GnuplotTest, PlacesPanelsInTheirBoxes) {
  Figure figure = parabola(1.0, 1.0);
  figure.panels.push_back(figure.panels[0]);
  figure.panels[0].box = Box{0.1, 0.45, 0.6, 0.9};
  figure.panels[1].box = Box{0.55, 0.95, 0.1, 0.4};
  const std::vector<Point> at = dots(svg(figure));
  ASSERT_EQ(at.size(), 22U);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Box box = *figure.panels[i / 11].box;
    EXPECT_GT(at[i].x, 640 * box.left);
    EXPECT_LT(at[i].x, 640 * box.right);
    EXPECT_GT(at[i].y, 400 * (1.0 - box.top));
    EXPECT_LT(at[i].y, 400 * (1.0 - box.bottom));
  }
}

TEST_F(GnuplotTest, NamesThePowerOfTenOfItsNumbers) {
  const std::string drawn = svg(parabola(1e6, 1e-7));
  EXPECT_EQ(texts(drawn, "speed \\(10\u2076 rad/s\\)").size(), 1U) << drawn;
  EXPECT_EQ(texts(drawn, "thrust \\(10\u207b\u2076 N\\)").size(), 1U) << drawn;
  EXPECT_EQ(texts(drawn, "10").size(), 2U) << "10 * 10^6 rad/s and 10 * 10^-6 N";
  EXPECT_EQ(texts(svg(parabola(1.0, 1.0)), "speed \\(rad/s\\)").size(), 1U);
}

TEST_F(GnuplotTest, PlacesTheLegendAboveTheData) {
  Figure figure = parabola(1.0, 1.0);
  figure.panels[0].series[0].label = "readings";
  const std::string drawn = svg(figure);
  const std::vector<Point> legend = texts(drawn, "readings");
  ASSERT_EQ(legend.size(), 1U) << drawn;
  const std::vector<Point> at = dots(drawn);
  const auto below = [&](const Point& dot) { return dot.y > legend[0].y + 10.0; };
  EXPECT_EQ(at.size(), 12U);
  EXPECT_EQ(std::count_if(at.begin(), at.end(), below), 11) << "all but that of the legend";
}

TEST_F(GnuplotTest, InterruptsLines) {
  const std::string drawn = svg(with(Style::kLine, {{0.0, 1.0}, {1.0, 2.0}, kGap, {2.0, 3.0}, {3.0, 3.0}}));
  const std::string whole = svg(with(Style::kLine, {{0.0, 1.0}, {1.0, 2.0}, {2.0, 3.0}, {3.0, 3.0}}));
  const auto moves = [](const std::string& text) {
    const std::size_t plot = text.find("_plot_1");
    return std::count(text.begin() + static_cast<std::ptrdiff_t>(plot), text.end(), 'M');
  };
  EXPECT_EQ(moves(drawn), moves(whole) + 1) << drawn;
}

TEST_F(GnuplotTest, DrawsEveryStyleInThePlaneAndLinesInSpace) {
  Figure figure = one_panel("all", "x", "y");
  const std::vector<Point> points = {{1.0, 2.0}, {2.0, 4.0}, {3.0, 3.0}};
  for (const Style style :
       {Style::kLine, Style::kDashes, Style::kSteps, Style::kDots, Style::kCrosses, Style::kBand})
    figure.panels[0].series.push_back({style, Colour::kGreen, "", points});
  figure.panels[0].series.push_back(
      {Style::kBoxes, Colour::kBlue, "", {{4.0, 1.0}, {4.0, 2.0}, {4.0, 3.0}, {4.0, 4.0}, {4.0, 5.0}}});
  Panel space = figure.panels[0];
  space.in_space = space.equal = true;
  space.series = {{Style::kLine, Colour::kRed, "path", {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}}};
  figure.panels[0].box = Box{0.1, 0.45, 0.1, 0.9};
  space.box = Box{0.55, 0.95, 0.1, 0.9};
  figure.panels.push_back(space);
  const std::string drawn = svg(figure);
  for (int series = 1; series <= 7; ++series)
    EXPECT_NE(drawn.find("_plot_" + std::to_string(series) + "a\""), std::string::npos) << series;
  EXPECT_NE(drawn.find("stroke-dasharray"), std::string::npos);
  EXPECT_NE(drawn.find("fill-opacity"), std::string::npos);
  EXPECT_EQ(texts(drawn, "path").size(), 1U);
}

TEST_F(GnuplotTest, DrawsDataWithoutExtent) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const std::vector<Point>& points : std::vector<std::vector<Point>>{
           {}, {{0.0, 0.0}}, {{3.0, 3.0}, {3.0, 3.0}}, {{std::nan(""), 1.0}, {1.0, infinite}}}) {
    const std::string drawn = svg(with(Style::kDots, points));
    EXPECT_EQ(drawn.find("nan"), std::string::npos);
    EXPECT_EQ(drawn.find("inf"), std::string::npos);
    EXPECT_EQ(texts(drawn, "thrust \\(N\\)").size(), 1U);
  }
  EXPECT_NE(svg(Figure{}), "");
}

TEST_F(GnuplotTest, WritesAPngAndTheScriptThatDrawsIt) {
  Figure figure = parabola(1.0, 1.0);
  figure.width = 801;
  figure.height = 402;
  ASSERT_EQ(draw_png_if_installed(figure, folder_ / "some.png"), "");
  const std::string picture = text_of(folder_ / "some.png");
  EXPECT_EQ(picture.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(picture.substr(12, 12), std::string("IHDR\0\0\x03\x21\0\0\x01\x92", 12));  // 801 x 402
  fs::remove(folder_ / "some.png");
  const fs::path gnuplot = io::find_program("gnuplot");
  io::ChildProcess again({"gnuplot", gnuplot, {"some.gp"}, folder_ / "log", folder_});
  ASSERT_TRUE(again.wait(std::chrono::seconds(30)));
  EXPECT_EQ(text_of(folder_ / "some.png"), picture);
}

TEST_F(GnuplotTest, KeepsTheOldPictureIfGnuplotFails) {
  temporary_.write("some.png", "old");
  fs::create_directory(folder_ / "bin");
  tests::write_program(folder_ / "bin" / "gnuplot", "echo half > picture.png\necho out of paper >&2\nexit 3");
  const tests::ProgramPath path(folder_ / "bin");
  EXPECT_EQ(draw_png(parabola(1.0, 1.0), folder_ / "some.png"),
            "no picture was drawn: gnuplot ended with exit status 3: out of paper");
  EXPECT_EQ(text_of(folder_ / "some.png"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2) << "nothing half-written is left";
}

TEST_F(GnuplotTest, RefusesATruncatedPicture) {
  temporary_.write("some.png", "old");
  fs::create_directory(folder_ / "bin");
  tests::write_program(folder_ / "bin" / "gnuplot", "printf '\\211PNG half' > 0");
  const tests::ProgramPath path(folder_ / "bin");
  const std::string sentence = draw_png(parabola(1.0, 1.0), folder_ / "some.png");
  EXPECT_EQ(sentence.find("no picture was drawn: gnuplot wrote a truncated file; is "), 0U) << sentence;
  EXPECT_EQ(text_of(folder_ / "some.png"), "old");
  EXPECT_THROW(draw_png_if_installed(parabola(1.0, 1.0), folder_ / "some.png"), std::runtime_error);
}

TEST_F(GnuplotTest, ReportsThatGnuplotIsNotInstalled) {
  const tests::ProgramPath path(folder_);
  EXPECT_EQ(draw_png(parabola(1.0, 1.0), folder_ / "some.png"),
            "no picture was drawn: gnuplot is not installed");
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_EQ(draw_png_if_installed(parabola(1.0, 1.0), folder_ / "some.png"),
            "no picture was drawn: gnuplot is not installed (some.gp draws it)");
}

// A flight on a loaded computer has not failed for that.
TEST_F(GnuplotTest, ReportsThatGnuplotIsSlow) {
  fs::create_directory(folder_ / "bin");
  tests::write_program(folder_ / "bin" / "gnuplot", "exec /bin/sleep 600");
  const tests::ProgramPath path(folder_ / "bin");
  EXPECT_EQ(draw_png_if_installed(parabola(1.0, 1.0), folder_ / "some.png", std::chrono::seconds(1)),
            "no picture was drawn: gnuplot took longer than 1 s (some.gp draws it)");
  EXPECT_TRUE(fs::exists(folder_ / "some.gp"));
}

TEST_F(GnuplotTest, ReportsAFileThatCannotBeWritten) {
  EXPECT_EQ(draw_png(parabola(1.0, 1.0), folder_ / "none" / "some.png"),
            (folder_ / "none" / "some.png").string() + ": cannot be written: No such file or directory");
}

}  // namespace swiftlet::plot::gnuplot_test

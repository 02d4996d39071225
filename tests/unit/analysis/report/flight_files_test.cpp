#include "swiftlet/analysis/report/flight_files.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/command_line/child_process.hpp"
#include "tests/support/program_path.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/analysis/flown_flight.hpp"

namespace swiftlet::analysis::flight_files_test {

namespace fs = std::filesystem;

class FlightFilesTest : public testing::Test {
 protected:
  tests::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST_F(FlightFilesTest, DrawsAPicture) {
  ASSERT_FALSE(io::find_program("gnuplot").empty()) << "install the packages of packages.txt";
  const record::Window window = {1'000'000'000, 3'000'000'000};
  FlightReport report;
  report.mission = "it's_a 'square'";  // must be escaped for gnuplot
  report.duration_s = 2.0;
  EXPECT_EQ(draw_flight(folder_, flown(1000, 1000), report, window), "");
  std::ifstream picture(folder_ / "flight.png", std::ios::binary);
  std::string magic(8, '\0');
  picture.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(fs::file_size(folder_ / "flight.png"), 20'000U);
  EXPECT_TRUE(fs::exists(folder_ / "flight.gp")) << "kept to draw the picture again";
}

// The script contains the data that it draws.
TEST_F(FlightFilesTest, DrawsPositionsPathAndErrors) {
  FlightReport report;
  report.mission = "square";
  report.vehicle = "kaylion";
  report.control = "motor_lag";
  report.errors.rms_3d_m = 0.001;
  report.errors.peak_3d_m = 0.0047;
  draw_flight(folder_, flown(30, 10), report, {1'010'000'000, 1'100'000'000});
  const std::string script = text_of(folder_ / "flight.gp");
  for (const char* const part :
       {"'square - kaylion, motor_lag: 3-D error RMS 1.0 mm, peak 4.7 mm over 0 s - NOT completed'",
        "'north x (m)'", "'east y (m)'", "'down z (m)'", "'error, flown - reference (mm)'",
        "'time from the start of the mission (s)'", "'plan view'", "'height -z (m)'", "title 'flown'",
        "title 'reference'", "title '3-D'",
        "\n0.01 0.51 0\n",               // north over time, of the truth
        "\n0.01 0.511 0\n",              // and of the reference
        "\n0.04 0.525 0\n",              // also without a reference
        "\n0.25 0.51 1\n",               // east, north, height
        "EOD\n0 -1 0\n0.01 -1 0\nEOD"})  // north errors, mm, in the window alone
    EXPECT_NE(script.find(part), std::string::npos) << part << "\n" << script;
}

// On the axis of the picture, and not those that the flight did not come to.
TEST_F(FlightFilesTest, MarksFaults) {
  record::Flight flight = flown(30, 10);
  flight.faults = {{1'050'000'000, 1'070'000'000, "push, at_s 1.05, for_s 0.02"},
                   {9'000'000'000, 9'500'000'000, "mocap_stop, at_s 9, for_s 0.5"}};
  draw_flight(folder_, flight, {}, {1'010'000'000, 1'100'000'000});
  const std::string script = text_of(folder_ / "flight.gp");
  EXPECT_NE(script.find("set arrow from 0.04,graph 0"), std::string::npos) << script;
  EXPECT_NE(script.find("set object rectangle from 0.04,graph 0 to 0.06,graph 1"), std::string::npos);
  EXPECT_NE(script.find("set label 'push' at 0.04,"), std::string::npos);
  EXPECT_EQ(script.find("mocap_stop"), std::string::npos);
}

TEST_F(FlightFilesTest, ReportsWhyNoPictureIsDrawn) {
  const tests::ProgramPath empty(folder_);
  EXPECT_EQ(draw_flight(folder_, {}, {}, {}),
            "no picture was drawn: gnuplot is not installed (flight.gp draws it)");
}

TEST_F(FlightFilesTest, ThrowsWhenTheFolderIsMissing) {
  EXPECT_THROW(write_report_json(folder_ / "gone" / "report.json", {}), std::runtime_error);
}

}  // namespace swiftlet::analysis::flight_files_test

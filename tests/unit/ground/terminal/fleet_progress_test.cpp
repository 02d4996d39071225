#include "swiftlet/ground/terminal/fleet_progress.hpp"

#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground::fleet_progress_test {

std::vector<std::string> lines_of(const std::vector<std::string>& vehicles) {
  testing::internal::CaptureStderr();
  {
    io::ProgressLine line;
    FleetProgress progress(line, vehicles);
    for (std::size_t i = 0; i < vehicles.size(); ++i)
      progress.of(i).update(1, " 12.1 s  2/6 waypoint    ( 2.00, -0.50, -1.00) m,   0.7 mm off, 4.03 V");
  }
  std::istringstream printed(testing::internal::GetCapturedStderr());
  std::vector<std::string> lines;
  for (std::string line; std::getline(printed, line);) lines.push_back(line);
  return lines;
}

TEST(FleetProgress, KeepsTo80ColumnsInALog) {
  for (const std::size_t count : {1U, 2U, 5U, 6U, 16U}) {
    std::vector<std::string> vehicles;
    for (std::size_t i = 1; i <= count; ++i) vehicles.push_back("kl" + std::to_string(i));
    const std::vector<std::string> lines = lines_of(vehicles);
    ASSERT_FALSE(lines.empty());
    for (const std::string& line : lines) EXPECT_LE(line.size(), 80U) << line;
  }
}

TEST(FleetProgress, ShowsEachOfAFewVehicles) {
  const std::string line = lines_of({"kl1", "kl2"}).back();
  EXPECT_NE(line.find("kl1 12.1 s 2/6 waypoint"), std::string::npos) << line;
  EXPECT_NE(line.find("kl2 12.1 s 2/6 waypoint"), std::string::npos) << line;
}

TEST(FleetProgress, ShowsWhatEachOfThreeFlies) {
  const std::string line = lines_of({"kl1", "kl2", "kl3"}).back();
  EXPECT_NE(line.find("kl3 12.1 s 2/6 waypoint"), std::string::npos) << line;
}

}  // namespace swiftlet::ground::fleet_progress_test

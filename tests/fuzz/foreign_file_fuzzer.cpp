// Fuzzes files that are brought into a form of ours before they are read: tables of other programs, lists of waypoints,
// and logs of the Crazyflie, whose CRC-32 is made right first. SWIFTLET_FUZZED_PARSER selects the form of each program.
#include <string>
#include <zlib.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/missions/crazyflie_log.hpp"
#include "swiftlet/io/missions/foreign_table.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/waypoint_list.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

namespace {

const control::Limits& limits() {
  static const control::Limits limits;
  return limits;
}

void demand_flyable(const io::MissionFile& file) {
  const control::Outcome outcome = control::check(file.mission, limits());
  if (!outcome.accepted) std::fprintf(stderr, "%s\n", outcome.reason);
  tests::demand(outcome.accepted, "control accepts a mission that was read");
}

[[maybe_unused]] void foreign_table(const std::string& text) {
  for (const char* const columns : {"", "t,x,y,z", "x,y,z,yaw [deg]"}) {
    tests::is_read([&] {
      const io::ForeignTable table = io::read_foreign_table(text, tests::kFuzzedFile, columns);
      const auto parse = [&](auto* parser) {
        demand_flyable(parser(table.text, tests::kFuzzedFile, limits(), {}, table.first_line));
      };
      switch (io::detect_format(table.text, tests::kFuzzedFile)) {
        case io::MissionFormat::kPolynomialCsv:
          return parse(io::parse_polynomial_csv);
        case io::MissionFormat::kSampledCsv:
          return parse(io::parse_sampled_csv);
        case io::MissionFormat::kWaypointCsv:
          return parse(io::parse_waypoint_csv);
        default:
          return;
      }
    });
  }
}

[[maybe_unused]] void waypoint_list(const std::string& text) {
  tests::is_read([&] {
    demand_flyable(io::parse_qgroundcontrol_plan(
        io::plan_of_waypoint_list("QGC WPL 110\n" + text, tests::kFuzzedFile), tests::kFuzzedFile, limits()));
  });
}

[[maybe_unused]] void crazyflie_log(const std::string& bytes) {
  std::string log = "\xBC" + bytes;
  auto crc =
      static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const unsigned char*>(log.data()), log.size()));
  for (int i = 0; i < 4; ++i, crc >>= 8U) log += static_cast<char>(crc & 0xFFU);
  tests::is_read([&] {
    demand_flyable(io::parse_sampled_csv(io::read_crazyflie_log(log, tests::kFuzzedFile).table,
                                         tests::kFuzzedFile, limits()));
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SWIFTLET_FUZZED_PARSER(std::string(tests::text_of(data, size)));
  return 0;
}

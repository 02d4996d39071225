// Fuzzes missions of other programs: tables and plans, lists of waypoints, and logs of the Crazyflie, whose CRC-32 is made
// right first. SWIFTLET_FUZZED_PARSER selects the form of each program.
#include <string>
#include <zlib.h>

#include "tests/fuzz/mission_reading.hpp"

using namespace swiftlet;

namespace {

void read(const std::string& text, const io::FileOptions& options = {}) {
  tests::expect_flyable(
      [&] { return io::parse_any_mission_file(text, tests::kFuzzedFile, tests::kFuzzedLimits, options); });
}

[[maybe_unused]] void foreign_mission(const std::string& text) {
  for (const char* const columns : {"", "t,x,y,z", "x,y,z,yaw [deg]"}) {
    io::FileOptions options;
    options.columns = columns;
    read(text, options);
  }
}

[[maybe_unused]] void waypoint_list(const std::string& text) { read("QGC WPL 110\n" + text); }

[[maybe_unused]] void crazyflie_log(const std::string& bytes) {
  std::string log = "\xBC" + bytes;
  auto crc =
      static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const unsigned char*>(log.data()), log.size()));
  for (int i = 0; i < 4; ++i, crc >>= 8U) log += static_cast<char>(crc & 0xFFU);
  read(log);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SWIFTLET_FUZZED_PARSER(std::string(tests::text_of(data, size)));
  return 0;
}

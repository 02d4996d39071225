// Fuzzes mission files of this project.
#include "tests/fuzz/mission_reading.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(tests::text_of(data, size));
  tests::expect_flyable(
      [&] { return io::parse_mission_file(text, tests::kFuzzedFile, tests::kFuzzedLimits); });
  return 0;
}

// Fuzzes mission files of this project.
#include <cmath>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const control::Limits limits;
  const std::string text(tests::text_of(data, size));
  tests::is_read([&] {
    const io::MissionFile file = io::parse_mission_file(text, tests::kFuzzedFile, limits);
    const control::Outcome outcome = control::check(file.mission, limits);
    if (!outcome.accepted) std::fprintf(stderr, "%s\n", outcome.reason);
    tests::demand(outcome.accepted, "control accepts a mission that was read");
    const double duration_s = io::planned_duration_s(file.mission, limits);
    tests::demand(std::isfinite(duration_s) && duration_s > 0.0,
                  "the duration of a mission is finite and positive");
  });
  return 0;
}

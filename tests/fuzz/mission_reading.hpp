// Expectation of every reader of missions: what it reads, control accepts.
#pragma once

#include <cmath>
#include <cstdio>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "tests/fuzz/refusal.hpp"

namespace swiftlet::tests {

inline const control::Limits kFuzzedLimits;

// parse: returns the mission file that it reads, with kFuzzedLimits.
template <class Parse>
void expect_flyable(const Parse& parse) {
  is_read([&] {
    const io::MissionFile file = parse();
    const control::Outcome outcome = control::check(file.mission, kFuzzedLimits);
    if (!outcome.accepted) std::fprintf(stderr, "%s\n", outcome.reason);
    demand(outcome.accepted, "control accepts a mission that was read");
    const double duration_s = io::planned_duration_s(file.mission, kFuzzedLimits);
    demand(std::isfinite(duration_s) && duration_s > 0.0, "the duration of a mission is finite and positive");
  });
}

}  // namespace swiftlet::tests

// Starts programs with another system clock.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace swiftlet::tests {

// How far the clock is off (shifted_clock.cpp).
struct ClockShift {
  std::int64_t shift_s = 0;
  double drift_ppm = 0.0;
  double step_s = 0.0;
  double step_after_s = 0.0;  // since the program was started
};

// For the programs that are started while it lives.
class ShiftedClock {
 public:
  ShiftedClock(const std::filesystem::path& file, const ClockShift& clock) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(&clock.shift_s), sizeof clock.shift_s);
    setenv("SWIFTLET_CLOCK_SHIFT", file.c_str(), 1);
    setenv("SWIFTLET_CLOCK_DRIFT_PPM", std::to_string(clock.drift_ppm).c_str(), 1);
    setenv("SWIFTLET_CLOCK_STEP_S", std::to_string(clock.step_s).c_str(), 1);
    setenv("SWIFTLET_CLOCK_STEP_AFTER_S", std::to_string(clock.step_after_s).c_str(), 1);
    setenv("LD_PRELOAD", SWIFTLET_PRELOADS, 1);
  }
  ~ShiftedClock() {
    for (const char* const variable : {"LD_PRELOAD", "SWIFTLET_CLOCK_SHIFT", "SWIFTLET_CLOCK_DRIFT_PPM",
                                       "SWIFTLET_CLOCK_STEP_S", "SWIFTLET_CLOCK_STEP_AFTER_S"})
      unsetenv(variable);
  }
  ShiftedClock(const ShiftedClock&) = delete;
  ShiftedClock& operator=(const ShiftedClock&) = delete;
};

}  // namespace swiftlet::tests

// Conversion between times in whole nanoseconds, as in every stamp, and in seconds.
#pragma once

#include <cmath>
#include <cstdint>

namespace swiftlet::math {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kNsPerS = 1e9;

// Not always the double that is nearest to the quotient by kNsPerS.
inline double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

// Rounded to the nearest nanosecond.
inline std::int64_t nanoseconds(double s) { return std::llround(1e9 * s); }

}  // namespace swiftlet::math

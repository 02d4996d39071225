#include "swiftlet/identification/bench/instruments.hpp"

#include "swiftlet/identification/fitting/checks.hpp"

namespace swiftlet::identification {

SpreadRatio spreads(const std::optional<double>& of_x, const std::vector<double>& x,
                    const std::optional<double>& of_y, const std::vector<double>& y) {
  if (of_x && of_y) return {*of_x, *of_y};
  return {full_scale(x), full_scale(y)};
}

}  // namespace swiftlet::identification

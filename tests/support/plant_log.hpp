// What swiftlet-plant says about real time.
#pragma once

#include <string>

namespace swiftlet::tests {

// By how much the plant fell behind real time in total, ms, from the last line of its log; 0 if that does not say.
inline double behind_real_time_ms(const std::string& log) {
  const std::size_t at = log.rfind("behind real time ");
  const std::size_t comma = log.find(", ", at);
  return at == std::string::npos || comma == std::string::npos ? 0.0 : std::stod(log.substr(comma + 2));
}

}  // namespace swiftlet::tests

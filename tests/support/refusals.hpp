// What processes have logged of datagrams that they refused.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace swiftlet::tests {

// The number of datagrams in the lines "refused 3 datagrams from 10.0.0.1; ..." of a log.
inline std::uint64_t refused_datagrams(const std::string& log) {
  constexpr std::string_view kBefore = "refused ", kBehind = " datagram";
  std::uint64_t refused = 0;
  for (std::size_t at = log.find(kBefore); at != std::string::npos; at = log.find(kBefore, at + 1)) {
    char* end = nullptr;
    const std::uint64_t count = std::strtoull(log.c_str() + at + kBefore.size(), &end, 10);
    if (std::string_view(end).substr(0, kBehind.size()) == kBehind) refused += count;
  }
  return refused;
}

}  // namespace swiftlet::tests

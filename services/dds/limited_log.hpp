// Warnings that other processes can cause.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace swiftlet::dds {

// Writes each line once in a time, and few lines. Not thread-safe.
class LimitedLog {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kPeriod{10};
  static constexpr std::size_t kMostLines = 16;

  // Logs the line, unless it, or kMostLines lines, were logged within kPeriod.
  void warn(const std::string& line, Time now);

 private:
  std::map<std::string, Time> written_;
};

}  // namespace swiftlet::dds

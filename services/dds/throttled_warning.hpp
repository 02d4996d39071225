// Logs refused messages of one topic, at most one line per second.
#pragma once

#include <cstdint>

#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::comms {

// Not thread-safe.
class ThrottledWarning {
 public:
  explicit ThrottledWarning(const char* topic) : topic_(topic) {}
  void note(const Fault& fault);

 private:
  const char* topic_;
  std::uint64_t suppressed_ = 0;
  std::int64_t next_ns_ = 0;
};

}  // namespace swiftlet::comms

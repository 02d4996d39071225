// Refused messages of one topic in the process's log: at most one line a second.
#pragma once

#include <cstdint>

#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::comms {

// One thread at a time calls it.
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

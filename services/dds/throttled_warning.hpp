// Logs refused messages of one topic, at most one line per second.
#pragma once

#include <chrono>
#include <cstdint>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::dds {

// Not thread-safe.
class ThrottledWarning {
 public:
  explicit ThrottledWarning(const char* topic) : topic_(topic) {}
  void note(const messages::Fault& fault) {
    ++refused_;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    runtime::log_warning("{} sample{} of {} refused; the last: {}", refused_, refused_ == 1 ? "" : "s",
                         topic_, fault.text);
    refused_ = 0;
    next_ = now + std::chrono::seconds(1);
  }

 private:
  const char* topic_;
  std::uint64_t refused_ = 0;  // since the last line
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace swiftlet::dds

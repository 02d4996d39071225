// The vehicle for which the calling thread works, as a prefix of its log lines: "kl3: rotors started".
#pragma once

#include <string>
#include <utility>

namespace swiftlet::runtime {

// Labels the log lines of its thread during its lifetime. An empty label adds nothing.
class LogLabel {
 public:
  explicit LogLabel(const std::string& label) : outer_(std::exchange(current_, &label)) {}
  explicit LogLabel(std::string&&) = delete;  // keeps a reference
  ~LogLabel() { current_ = outer_; }
  LogLabel(const LogLabel&) = delete;
  LogLabel& operator=(const LogLabel&) = delete;

  static std::string current() { return current_ == nullptr ? std::string() : *current_; }

 private:
  static inline thread_local const std::string* current_ = nullptr;
  const std::string* outer_;
};

}  // namespace swiftlet::runtime

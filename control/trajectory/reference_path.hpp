// The reference in time: rest at a place, or one polynomial segment after another.
#pragma once

#include <cstdint>

#include "control/trajectory/polynomial.hpp"

namespace swiftlet::control {

class ReferencePath {
 public:
  // Rest at the position and yaw of `at` from now on.
  void rest(const Reference& at);
  // The reference is `at`, as it is, until told otherwise.
  void pin(const Reference& at);
  // Follow the segment from start_ns; at its end, rest where it ends.
  void follow(const PolynomialSegment& segment, std::int64_t start_ns);

  Reference at(std::int64_t now_ns) const;
  bool finished(std::int64_t now_ns) const { return !moving_ || now_ns >= end_ns_; }
  std::int64_t end_ns() const { return end_ns_; }

 private:
  bool moving_ = false;
  PolynomialSegment segment_;
  std::int64_t start_ns_ = 0;
  std::int64_t end_ns_ = 0;
  Reference rest_;  // while not moving, and after the segment
};

}  // namespace swiftlet::control

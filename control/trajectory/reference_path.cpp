#include "control/trajectory/reference_path.hpp"

#include <cmath>

namespace swiftlet::control {
namespace {

Reference at_rest(const Reference& at) {
  Reference rest;
  rest.position_ned = at.position_ned;
  rest.yaw_rad = at.yaw_rad;
  return rest;
}

}  // namespace

void ReferencePath::rest(const Reference& at) { pin(at_rest(at)); }

void ReferencePath::pin(const Reference& at) {
  moving_ = false;
  rest_ = at;
}

void ReferencePath::follow(const PolynomialSegment& segment, std::int64_t start_ns) {
  moving_ = true;
  segment_ = segment;
  start_ns_ = start_ns;
  end_ns_ = start_ns + std::llround(segment.duration_s * 1e9);
  rest_ = at_rest(evaluate(segment, segment.duration_s));
}

Reference ReferencePath::at(std::int64_t now_ns) const {
  if (finished(now_ns)) return rest_;
  return evaluate(segment_, static_cast<double>(now_ns - start_ns_) * 1e-9);
}

}  // namespace swiftlet::control

// Yaw angle with its cosine and sine, for code that needs them more than once.
#pragma once

#include <cmath>

namespace swiftlet::math {

struct Heading {
  Heading() = default;
  Heading(double yaw)  // NOLINT(google-explicit-constructor)
      : yaw_rad(yaw), cosine(std::cos(yaw)), sine(std::sin(yaw)) {}

  double yaw_rad = 0.0;
  double cosine = 1.0;
  double sine = 0.0;
};

}  // namespace swiftlet::math

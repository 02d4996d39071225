// What the tests of mission formats share.
#pragma once

#include <string>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::io {

inline const std::string kData = tests::in_source("tests/data/");

// Limits of a field outdoors.
inline control::Limits field() {
  control::Limits limits;
  limits.fence_min_ned = {-30, -30, -12};
  limits.fence_max_ned = {30, 30, 0.2};
  return limits;
}

// The sentence with which a file is refused.
template <class Parse>
std::string refusal(Parse&& parse) {
  try {
    parse();
  } catch (const io::ConfigError& error) {
    return error.what();
  }
  return "it was accepted";
}

inline bool assumes(const MissionFile& file, const std::string& part) {
  for (const std::string& assumption : file.assumptions) {
    if (assumption.find(part) != std::string::npos) return true;
  }
  return false;
}

inline control::Reference at_path_start(const MissionFile& file) {
  return control::evaluate(file.mission.segments.front(), 0.0);
}

inline std::string polynomial_header() {
  std::string text = "duration";
  for (const char* axis : {"x", "y", "z", "yaw"}) {
    for (int k = 0; k < 8; ++k) text += std::string(",") + axis + "^" + std::to_string(k);
  }
  return text;
}
inline const std::string kPolynomialHeader = polynomial_header();

// Minimum jerk from rest at x to rest at x + distance east, at a height.
inline std::string polynomial_row(double duration_s, double x, double distance, double height,
                                  double yaw = 0.0) {
  const control::PolynomialSegment s =
      control::minimum_jerk({x, 0, height}, yaw, {x + distance, 0, height}, yaw, duration_s);
  std::string text = io::exact(duration_s);
  for (const control::Polynomial* const axis : {&s.x, &s.y, &s.z, &s.yaw}) {
    for (const double c : *axis) text += "," + io::exact(c);
  }
  return text;
}

}  // namespace swiftlet::io

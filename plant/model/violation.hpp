// Validation of plain parameter structs such as vehicles and settings.
#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/plant/model/setting.hpp"

namespace swiftlet::plant {

// One violated rule: the key in the parameter file and a sentence with value and limit.
struct Violation {
  std::string key;      // as in the file: "motor.time_constant", "rotors[2].position_frd"
  std::string message;  // "is -0.1, must be a finite number above 0"
};

// Collects violations. Each check returns true if the rule holds. A NaN violates every rule.
class RuleChecker {
 public:
  template <typename... Parts>
  void add(const std::string& key, const Parts&... parts) {
    std::ostringstream message;
    (message << ... << parts);
    violations_.push_back({key, message.str()});
  }

  bool finite(const std::string& key, double value) {
    return require(std::isfinite(value), key, "is ", value, ", must be a finite number");
  }
  bool above(const std::string& key, double value, double min) {
    return require(std::isfinite(value) && value > min, key, "is ", value, ", must be a finite number above ",
                   min);
  }
  bool at_least(const std::string& key, double value, double min) {
    return require(std::isfinite(value) && value >= min, key, "is ", value,
                   ", must be a finite number of at least ", min);
  }
  bool between(const std::string& key, double value, double min, double max) {
    return require(value >= min && value <= max, key, "is ", value, ", must be at least ", min,
                   " and at most ", max);
  }

  bool in_range(const std::string& key, double value, const Range& range) {
    if (range.kind == Range::Kind::kFinite) return finite(key, value);
    if (range.kind == Range::Kind::kAbove) return above(key, value, range.min);
    if (range.kind == Range::Kind::kAtLeast) return at_least(key, value, range.min);
    return range.kind == Range::Kind::kAny || between(key, value, range.min, range.max);
  }

  std::vector<Violation> take() { return std::move(violations_); }

 private:
  template <typename... Parts>
  bool require(bool holds, const std::string& key, const Parts&... parts) {
    if (!holds) add(key, parts...);
    return holds;
  }

  std::vector<Violation> violations_;
};

}  // namespace swiftlet::plant

// Headers of columns in tables, "speed [rpm]", and the units that they may state.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swiftlet::io {

// "speed [rpm]" -> "speed" and "rpm"; no unit without brackets.
struct Declaration {
  std::string name;
  std::optional<std::string> unit;
};
Declaration declaration_of(const std::string& header);

constexpr double kStandardGravity = 9.80665;  // m/s^2, one g

struct Unit {
  const char* name;
  double factor;  // to SI
  std::vector<const char*> also = {};
};
// The units of a quantity, first the one of SI.
using Units = std::vector<Unit>;

extern const Units kSeconds, kMetres, kMetresPerSecond, kAccelerations, kRadians, kRates;

// The unit of this name; null if the quantity has no such unit.
const Unit* unit_of(const Units& units, const std::string& name);

// "a, b or c"
std::string one_of(const std::vector<std::string>& choices, const std::string& last = " or ");

}  // namespace swiftlet::io

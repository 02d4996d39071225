#include "swiftlet/io/column.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/io/text.hpp"

namespace swiftlet::io {

const Units kSeconds = {{"s", 1.0, {"sec"}},
                        {"ms", 1e-3, {"msec"}},
                        {"us", 1e-6, {"usec", "\xc2\xb5s", "\xce\xbcs"}},
                        {"ns", 1e-9, {"nsec"}}};
const Units kMetres = {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}};
const Units kMetresPerSecond = {{"m/s", 1.0, {"m s^-1"}}, {"cm/s", 1e-2}};
const Units kAccelerations = {{"m/s^2", 1.0, {"m/s2", "m/s\xc2\xb2", "m s^-2"}},
                              {"g", kStandardGravity, {"G"}},
                              {"mg", 1e-3 * kStandardGravity, {"milli-g"}}};
const Units kRadians = {{"rad", 1.0}, {"deg", M_PI / 180.0}};
const Units kRates = {
    {"rad/s", 1.0, {"rads/s", "rad s^-1"}}, {"deg/s", M_PI / 180.0, {"dps", "\xc2\xb0/s"}}, {"mrad/s", 1e-3}};

Declaration declaration_of(const std::string& header) {
  const std::size_t open = header.find('[');
  if (open == std::string::npos || header.back() != ']') return {std::string(trimmed(header)), std::nullopt};
  return {std::string(trimmed(header.substr(0, open))),
          std::string(trimmed(header.substr(open + 1, header.size() - open - 2)))};
}

const Unit* unit_of(const Units& units, const std::string& name) {
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& unit) {
    return name == unit.name || std::find(unit.also.begin(), unit.also.end(), name) != unit.also.end();
  });
  return found == units.end() ? nullptr : &*found;
}

std::string one_of(const std::vector<std::string>& choices, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i)
    text += (i == 0 ? "" : i + 1 == choices.size() ? last : ", ") + choices[i];
  return text;
}

}  // namespace swiftlet::io

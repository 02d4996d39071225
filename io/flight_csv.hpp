// The header of the table of a flight, as `swiftlet log csv` writes it.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace swiftlet::io {

// columns: of the first line. True also for records of older versions, whose columns have no units.
inline bool is_flight_csv(const std::vector<std::string>& columns) {
  const auto has = [&](const char* name) {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  };
  return has("mode") && (has("ref_x_ned [m]") || has("ref_px"));
}

}  // namespace swiftlet::io

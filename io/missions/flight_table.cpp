#include "swiftlet/io/missions/flight_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::io {
namespace {

using io::ConfigError;

constexpr double kSampleAtRest_m_s = 1e-3;

struct FlightColumn {
  const char* header;   // in the table that is returned
  const char* written;  // in the table of a flight
  const char* older;    // in that of an older version; null: none
};
const std::vector<FlightColumn> kFlightColumns = {{"t [s]", "t [s]", "t"},
                                                  {"x_ned [m]", "ref_x_ned [m]", "ref_px"},
                                                  {"y_ned [m]", "ref_y_ned [m]", "ref_py"},
                                                  {"z_ned [m]", "ref_z_ned [m]", "ref_pz"},
                                                  {"vx_ned [m/s]", "ref_vx_ned [m/s]", "ref_vx"},
                                                  {"vy_ned [m/s]", "ref_vy_ned [m/s]", "ref_vy"},
                                                  {"vz_ned [m/s]", "ref_vz_ned [m/s]", "ref_vz"},
                                                  {"yaw_ned [rad]", "ref_yaw_ned [rad]", "ref_yaw"},
                                                  {"ax_ned [m/s^2]", "ref_ax_ned [m/s^2]", nullptr},
                                                  {"ay_ned [m/s^2]", "ref_ay_ned [m/s^2]", nullptr},
                                                  {"az_ned [m/s^2]", "ref_az_ned [m/s^2]", nullptr}};
constexpr std::size_t kZ = 3, kVx = 4, kAx = 8;

std::optional<std::size_t> find(const std::vector<std::string>& header, const char* name) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

// The position in the table of a flight of each column of kFlightColumns; shorter without accelerations.
std::vector<std::size_t> places(const std::vector<std::string>& header, const std::string& file_name) {
  const bool older = find(header, "t").has_value();
  std::vector<std::size_t> places;
  for (const FlightColumn& column : kFlightColumns) {
    const char* const name = older ? column.older : column.written;
    if (name == nullptr) break;
    const auto place = find(header, name);
    if (!place) {
      throw ConfigError(file_name, 1, "header",
                        std::string("has no column ") + name + ", which the table of a flight has");
    }
    places.push_back(*place);
  }
  return places;
}

struct Row {
  int line = 0;
  std::vector<double> numbers;           // in the order of kFlightColumns
  std::vector<std::string_view> fields;  // as they are written

  double speed() const { return std::hypot(numbers[kVx], numbers[kVx + 1], numbers[kVx + 2]); }
  bool is_between_takeoff_and_landing() const {
    return -numbers[kZ] >= kLeastHeight_m && speed() <= kSampleAtRest_m_s;
  }
};

// The rows that have a reference. lines: the first is the header.
std::vector<Row> rows_of(const std::vector<CsvLine>& lines, const std::vector<std::string>& header,
                         const std::vector<std::size_t>& places, const std::string& file_name) {
  std::vector<Row> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto& [number, text] = lines[i];
    const std::vector<std::string_view> fields = csv_fields(text, header.size());
    require_fields(fields, header, file_name, number);
    if (fields[places[1]].empty()) continue;
    Row& row = rows.emplace_back();
    row.line = number;
    for (const std::size_t place : places) {
      row.numbers.push_back(csv_number(fields[place], header[place], file_name, number));
      row.fields.push_back(fields[place]);
    }
  }
  return rows;
}

// The calmest row from one at rest on, as long as they are at rest: that is not the last of the climb before it.
template <class Iterator>
Iterator calmest(Iterator row, Iterator end) {
  const auto moves = std::find_if(row, end, [](const Row& r) { return !r.is_between_takeoff_and_landing(); });
  return std::min_element(row, moves, [](const Row& a, const Row& b) { return a.speed() < b.speed(); });
}

// The path begins and ends at rest: what is left of its motion in the record is that of the next moment.
void stop(std::vector<double>& numbers) {
  for (std::size_t i = kVx; i < kVx + 3; ++i) numbers[i] = 0.0;
  for (std::size_t i = kAx; i < numbers.size(); ++i) numbers[i] = 0.0;
}

}  // namespace

Table reference_of_flight(std::string_view text, const std::string& file_name) {
  const std::vector<CsvLine> lines = csv_lines(text, file_name);
  const std::vector<std::string_view> names = csv_fields(lines.front().text);
  const std::vector<std::string> header(names.begin(), names.end());
  const std::vector<std::size_t> at = places(header, file_name);
  std::vector<Row> rows = rows_of(lines, header, at, file_name);
  const auto flown = [](const Row& row) { return row.is_between_takeoff_and_landing(); };
  const auto begin = calmest(std::find_if(rows.begin(), rows.end(), flown), rows.end());
  const auto end = calmest(std::find_if(rows.rbegin(), rows.rend(), flown), rows.rend()).base();
  if (begin == rows.end() || end - begin < 2) {
    throw ConfigError(file_name, 0, "",
                      fmt::format("has no reference between a take-off and a landing: it is never at rest at "
                                  "least {:g} m above the ground",
                                  kLeastHeight_m));
  }
  stop(begin->numbers);
  stop((end - 1)->numbers);
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < at.size(); ++i) columns.emplace_back(kFlightColumns[i].header);
  Table table(file_name, columns);
  std::for_each(begin, end, [&](const Row& row) { table.add_row(row.line, row.numbers, row.fields); });
  return table;
}

std::string extent_of(const Table& reference) {
  return fmt::format(
      "the reference of a recorded flight between take-off and landing, t = {:.2f} to {:.2f} s, in NED",
      reference.number(0, 0), reference.number(reference.row_count() - 1, 0));
}

}  // namespace swiftlet::io

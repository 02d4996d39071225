#include "swiftlet/io/missions/mission_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flight_csv.hpp"
#include "swiftlet/io/missions/flight_table.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

using Names = std::vector<std::string>;
using Fields = std::vector<std::string_view>;

// Parts of the orientation, and the beginnings of the names of quantities that a path does not need.
const Names kQuaternions = {"q*", "q_*", "q_rs_*", "orientation.*", "stateestimate.q*"};
const Names kLeftOut = {"w_",   "wx",   "wy",   "wz",    "omega",  "a_rot", "u_",    "jerk", "snap",
                        "b_w_", "b_a_", "roll", "pitch", "rpm",    "motor", "gyro.", "acc.", "pm.",
                        "rate", "tau",  "mot_", "f_",    "thrust", "red",   "green", "blue", "white"};

char separator_of(std::string_view line) {
  for (const char separator : {';', ',', '\t'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

// The lines of a file, apart.
struct Parts {
  std::optional<CsvLine> comment;  // the last before the rows
  std::vector<CsvLine> rows;       // the first may be a header
};

Parts parts_of(std::string_view text, const std::string& file) {
  Parts parts;
  for (const CsvLine& line : csv_lines(text, file)) {
    if (!is_comment(line.text)) {
      parts.rows.push_back(line);
    } else if (parts.rows.empty()) {
      parts.comment = line;
    }
  }
  return parts;
}

// Whether a column rises in steps that are equal to a tenth.
bool rises_evenly(const std::vector<Fields>& rows, std::size_t column) {
  if (rows.size() < 3) return false;
  std::vector<double> values;
  for (const Fields& row : rows) {
    const auto number = column < row.size() ? parse_number(row[column]) : std::nullopt;
    if (!number) return false;
    values.push_back(*number);
  }
  const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(std::abs(values[i] - values[i - 1] - step) <= 0.1 * step)) return false;
  }
  return step > 0.0;
}

[[noreturn]] void ask(const std::string& file, int line, const std::string& message) {
  throw ConfigError(file, line, "", "has no header; " + message);
}

// The columns of a table without a header.
Names assumed_columns(const std::vector<Fields>& rows, const std::string& file, int line) {
  const std::size_t count = rows.front().size();
  if (count == 3) return {"x", "y", "z"};
  if (count == 4) {
    const bool first = rises_evenly(rows, 0);
    if (first || rises_evenly(rows, 3)) {
      const char* const timed = first ? "t,x,y,z" : "x,y,z,t";
      ask(file, line,
          fmt::format(
              "its {} column rises in equal steps: {} or waypoints x,y,z,yaw? --columns {} or --columns "
              "x,y,z,yaw says which",
              first ? "first" : "last", timed, timed));
    }
    return {"x", "y", "z", "yaw"};
  }
  if (count == 8 && rises_evenly(rows, 0)) return {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
  ask(file, line,
      fmt::format("{} columns may be many things: --columns names them in order, such as --columns "
                  "t,x,y,z,qx,qy,qz,qw",
                  count));
}

// Stamps without a unit that are too large for seconds since 1970.
std::string unit_of_stamps(std::string_view first) {
  const double stamp = std::abs(parse_number(first).value_or(0.0));
  return stamp >= 1e17 ? "ns" : stamp >= 1e14 ? "us" : stamp >= 1e11 ? "ms" : "";
}

int decimals_of_unit(const std::string& unit) { return unit == "ns" ? 9 : unit == "us" ? 6 : 3; }

// A stamp in ns, us or ms from the first one, in s. Whole ones exactly: a double does not hold the ns since 1970.
std::string seconds_since(std::string_view first, std::string_view stamp, const std::string& unit) {
  std::int64_t a = 0;
  std::int64_t b = 0;
  const auto whole = [](std::string_view text, std::int64_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  };
  const int decimals = decimals_of_unit(unit);
  if (whole(first, a) && whole(stamp, b))
    return fmt::format("{:.{}f}", static_cast<double>(b - a) / std::pow(10.0, decimals), decimals);
  const std::size_t point = std::min(stamp.find('.'), stamp.size() - 1);
  const double from_first = parse_number(stamp).value_or(0.0) - parse_number(first).value_or(0.0);
  return fmt::format("{:.{}f}", from_first / std::pow(10.0, decimals), decimals + stamp.size() - 1 - point);
}

// Names of columns, in which line they stand, and the rows below as they are written.
struct Written {
  std::string file;
  Names header;
  int header_line = 0;  // 0: none
  std::vector<int> lines;
  std::vector<Fields> rows;
};

// A column of a table of another program. Without motion and quaternion it is left out.
struct ForeignColumn {
  std::string given;
  std::optional<Motion> motion;
  std::optional<std::size_t> quaternion;  // of w, x, y, z
  std::string axes;                       // "_enu"
  std::string unit;                       // empty: that of SI
};

// Throws ConfigError for a name that is not known.
ForeignColumn column_of(const std::string& given, const std::string& file, int line) {
  const MotionDeclaration declared = motion_declaration_of(lower(given));
  ForeignColumn column{given, {}, {}, declared.axes, declaration_of(given).unit.value_or("")};
  if (declared.axes != "_frd") column.motion = motion_of(declared.name);
  for (std::size_t k = 0; k < 4 && declared.axes.empty(); ++k) {
    for (std::string name : kQuaternions) {
      std::replace(name.begin(), name.end(), '*', "wxyz"[k]);
      if (name == declared.name) column.quaternion = k;
    }
  }
  if (column.motion) {
    const Unit* const unit = unit_of(units_of(*column.motion), column.unit);
    if (unit != nullptr) column.unit = unit->name;
  }
  const bool known = column.motion || column.quaternion ||
                     std::any_of(kLeftOut.begin(), kLeftOut.end(), [&](const std::string& begin) {
                       return declared.name.rfind(begin, 0) == 0;
                     });
  if (!known)
    throw ConfigError(file, line, "header",
                      "has the column " + given +
                          ", which is not known; --columns names all columns in order, such as --columns "
                          "t,x,y,z,w_,w_ with w_ for what is not used");
  return column;
}

// Brings a table of another program into the columns of motion_columns.hpp.
class Translation {
 public:
  explicit Translation(const Written& table) : table_(table) {
    for (const std::string& name : table.header)
      columns_.push_back(column_of(name, table.file, std::max(table.header_line, 1)));
    require_fields(table.rows.front(), table.header, table.file, table.lines.front());
    std::array<bool, 4> given{};
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!columns_[i].quaternion) continue;
      quaternion_[*columns_[i].quaternion] = i;
      given[*columns_[i].quaternion] = true;
    }
    turns_ = std::all_of(given.begin(), given.end(), [](bool part) { return part; }) &&
             std::none_of(columns_.begin(), columns_.end(), [](const ForeignColumn& column) {
               return column.motion == Motion::kYaw || column.motion == Motion::kYawRate;
             });
    foreign_ = !std::all_of(table.header.begin(), table.header.end(), is_motion);
    settle_units();
  }

  MissionTable read() const {
    MissionTable out{{table_.file, header()}, {}};
    if (stamps_are_guessed_) out.assumptions.push_back("stamps are taken as " + stamp_unit_);
    if (foreign_)
      out.assumptions.push_back(fmt::format("the columns {} are read as {}{}", fmt::join(table_.header, ", "),
                                            fmt::join(header(), ", "),
                                            turns_ ? ", the yaw from the quaternion" : ""));
    Names left_out;
    for (const ForeignColumn& column : columns_) {
      if (!column.motion && !column.quaternion) left_out.push_back(column.given);
    }
    if (!left_out.empty()) out.assumptions.push_back(fmt::format("not used: {}", fmt::join(left_out, ", ")));
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const Names cells = cells_of(table_.rows[row], table_.lines[row]);
      out.table.add_row(table_.lines[row], Fields(cells.begin(), cells.end()));
    }
    return out;
  }

 private:
  // Units of SI may be dropped, since a table of another program names no frame. Large stamps become seconds.
  void settle_units() {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      ForeignColumn& stamps = columns_[i];
      if (stamps.motion != Motion::kT) continue;
      first_stamp_ = table_.rows.front()[i];
      stamps_are_guessed_ = stamps.unit.empty() && !unit_of_stamps(first_stamp_).empty();
      const bool converted =
          stamps.unit == "ns" || (foreign_ && (stamps.unit == "us" || stamps.unit == "ms"));
      stamp_unit_ = stamps.unit.empty() ? unit_of_stamps(first_stamp_) : converted ? stamps.unit : "";
      if (!stamp_unit_.empty()) stamps.unit.clear();
    }
    const bool plain = std::all_of(columns_.begin(), columns_.end(), [](const ForeignColumn& column) {
      return !column.motion || column.unit.empty() || column.unit == units_of(*column.motion).front().name;
    });
    for (ForeignColumn& column : columns_) {
      if (foreign_ && plain) column.unit.clear();
      has_units_ = has_units_ || (column.motion && !column.unit.empty());
    }
  }

  Names header() const {
    const auto name = [&](Motion motion, const std::string& axes, const std::string& unit) {
      if (!has_units_) return name_of(motion) + axes;
      return name_of(motion) + axes + " [" + (unit.empty() ? units_of(motion).front().name : unit) + "]";
    };
    Names names;
    for (const ForeignColumn& column : columns_) {
      if (column.motion) names.push_back(name(*column.motion, column.axes, column.unit));
    }
    if (turns_) names.push_back(name(Motion::kYaw, "", ""));
    return names;
  }

  Names cells_of(const Fields& fields, int line) const {
    require_fields(fields, table_.header, table_.file, line);
    Names cells;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const ForeignColumn& column = columns_[i];
      if (!column.motion) continue;
      csv_number(fields[i], column.given, table_.file, line);
      const bool is_stamp = column.motion == Motion::kT && !stamp_unit_.empty();
      cells.push_back(is_stamp ? seconds_since(first_stamp_, fields[i], stamp_unit_)
                               : std::string(fields[i]));
    }
    if (turns_) cells.push_back(yaw_of(fields, line));
    return cells;
  }

  // The yaw in the frame of the file, as text: the direction of body x, also for a vehicle that is tilted.
  std::string yaw_of(const Fields& fields, int line) const {
    std::array<double, 4> q{};
    Names given;
    for (std::size_t k = 0; k < 4; ++k) {
      given.push_back(columns_[quaternion_[k]].given);
      q[k] = csv_number(fields[quaternion_[k]], given.back(), table_.file, line);
    }
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::abs(length - 1.0) > 0.01)
      throw ConfigError(
          table_.file, line, "",
          fmt::format("{} are a quaternion of length {:.3f}, must be 1", fmt::join(given, ", "), length));
    const double yaw = std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
    const std::string_view written = fields[quaternion_[3]];
    const std::size_t point = written.find('.');
    const std::size_t decimals = point == std::string_view::npos ? 3 : written.size() - point - 1;
    return fmt::format("{:.{}f}", yaw, std::clamp<std::size_t>(decimals, 3, 9));
  }

  const Written& table_;
  std::vector<ForeignColumn> columns_;
  std::array<std::size_t, 4> quaternion_{};
  bool turns_ = false;    // the quaternion becomes a yaw
  bool foreign_ = false;  // some names are not those of this project
  bool has_units_ = false;
  std::string_view first_stamp_;
  std::string stamp_unit_;  // of stamps that become seconds since the first
  bool stamps_are_guessed_ = false;
};

bool is_header(const Fields& fields) { return !fields.empty() && !is_number(fields.front()); }

bool is_polynomial(const Names& columns) { return lower(columns.front()) == "duration"; }

// A table in the dialect of this project, which has no blank lines and no comments.
bool is_own(const Parts& parts, const std::string& text) {
  const Fields first = csv_fields(parts.rows.front().text);
  const bool dense = parts.rows.size() == static_cast<std::size_t>(parts.rows.back().number);
  if (!dense || text.find_first_of("#%") != std::string::npos || !is_header(first)) return false;
  return std::all_of(first.begin(), first.end(),
                     [](std::string_view name) { return is_motion(std::string(name)); });
}

Written written(const Parts& parts, const std::string& file, char separator) {
  Written table;
  table.file = file;
  const std::size_t columns = csv_fields(parts.rows.front().text, 1, separator).size();
  for (const CsvLine& line : parts.rows) {
    table.lines.push_back(line.number);
    table.rows.push_back(csv_fields(line.text, columns, separator));
  }
  if (is_header(table.rows.front())) {
    table.header.assign(table.rows.front().begin(), table.rows.front().end());
    table.header_line = table.lines.front();
    table.rows.erase(table.rows.begin());
    table.lines.erase(table.lines.begin());
  } else if (parts.comment) {
    const std::string_view comment = parts.comment->text;
    const std::string_view text =
        comment.substr(std::min(comment.find_first_not_of("#%/ \t"), comment.size()));
    const Fields names = csv_fields(text, 1, separator_of(text));
    if (is_header(names) && names.size() == table.rows.front().size()) {
      table.header.assign(names.begin(), names.end());
      table.header_line = parts.comment->number;
    }
  }
  return table;
}

// A name of --columns with the frame and the unit that the header states for the column, unless the option names a unit.
std::string named(const std::string& name, const std::string& given, const Written& table) {
  const MotionDeclaration by_option = motion_declaration_of(name);
  const MotionDeclaration by_header = motion_declaration_of(given);
  const auto refuse = [&](const std::string& why) {
    throw ConfigError(table.file, table.header_line, "header",
                      "has the column " + given + ", which --columns names " + name + why);
  };
  const std::optional<Motion> motion = motion_of(by_option.name);
  if (!motion) return name;
  if (!by_option.axes.empty() && !by_header.axes.empty() && by_option.axes != by_header.axes)
    refuse(": which frame is it?");
  const std::string unit = by_option.unit.value_or(by_header.unit.value_or(""));
  if (!unit.empty() && unit_of(units_of(*motion), unit) == nullptr) refuse(": that has no unit " + unit);
  return by_option.name + (by_option.axes.empty() ? by_header.axes : by_option.axes) +
         (unit.empty() ? "" : " [" + unit + "]");
}

// The names of the columns where the file does not say them, or --columns says others.
void name_columns(Written& table, const std::string& columns, std::vector<std::string>& assumptions) {
  if (!columns.empty()) {
    const Fields names = csv_fields(columns);
    if (!table.rows.empty() && names.size() != table.rows.front().size())
      throw ConfigError(
          table.file, table.lines.front(), "",
          fmt::format("has {} columns, --columns names {}", table.rows.front().size(), names.size()));
    table.header.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
      table.header[i] = named(std::string(names[i]), table.header[i], table);
  } else if (table.header.empty()) {
    table.header = assumed_columns(table.rows, table.file, table.lines.front());
    assumptions.push_back(
        fmt::format("the file has no header: its columns are taken as {}", fmt::join(table.header, ", ")));
  }
}

// The columns as they are named.
MissionTable as_named(const Written& table) {
  Names names = table.header;
  if (is_polynomial(names)) {
    for (std::string& name : names) name = lower(name);
    require_header({names.begin(), names.end()}, polynomial_columns(), table.file,
                   std::max(table.header_line, 1));
  }
  MissionTable out{{table.file, names}, {}};
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    out.table.add_row(table.lines[row], table.rows[row]);
  return out;
}

}  // namespace

MissionFormat format_of(const std::vector<std::string>& columns) {
  if (columns.empty()) return MissionFormat::kYaml;
  if (is_polynomial(columns)) return MissionFormat::kPolynomialCsv;
  const auto has = [&](const char* name) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const std::string& column) { return motion_declaration_of(column).name == name; });
  };
  if (has("t")) return MissionFormat::kSampledCsv;
  return has("x") && has("y") ? MissionFormat::kWaypointCsv : MissionFormat::kYaml;
}

MissionTable read_mission_table(const std::string& text, const std::string& file_name,
                                const std::string& columns) {
  const Parts parts = parts_of(text, file_name);
  if (parts.rows.empty()) return {{file_name, {}}, {}};
  if (columns.empty() && is_flight_csv(first_csv_line(parts.rows.front().text, file_name))) {
    Table reference = reference_of_flight(text, file_name);
    std::string extent = extent_of(reference);
    return {std::move(reference), {std::move(extent)}};
  }
  const bool own = columns.empty() && is_own(parts, text);
  const bool has_rows = std::any_of(parts.rows.begin(), parts.rows.end(), [](const CsvLine& line) {
    return is_number(csv_fields(line.text, 1, separator_of(line.text)).front());
  });
  Written table = written(parts, file_name, own ? ',' : separator_of(parts.rows.front().text));
  if (!own && !has_rows && format_of(table.header) == MissionFormat::kYaml)
    return {{file_name, table.header}, {}};
  std::vector<std::string> assumptions;
  if (!own && has_rows) name_columns(table, columns, assumptions);
  MissionTable out =
      own || !has_rows || is_polynomial(table.header) ? as_named(table) : Translation(table).read();
  out.assumptions.insert(out.assumptions.begin(), assumptions.begin(), assumptions.end());
  return out;
}

}  // namespace swiftlet::io

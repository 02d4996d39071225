#include "swiftlet/io/missions/foreign_table.hpp"

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
#include "swiftlet/io/missions/foreign_columns.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

using Fields = std::vector<std::string>;

// separator ' ': any number of blanks and tabs.
Fields split(const std::string& line, char separator) {
  Fields fields;
  std::string field;
  for (const char c : line + separator) {
    if (c != separator && !(separator == ' ' && c == '\t')) {
      field += c;
    } else if (separator != ' ' || !field.empty()) {
      fields.push_back(without_blanks(field));
      field.clear();
    }
  }
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return fields;
}

char separator_of(const std::string& line) {
  for (const char separator : {';', ',', '\t'}) {
    if (line.find(separator) != std::string::npos) return separator;
  }
  return ' ';
}

bool is_comment(const std::string& line) {
  return line.rfind('#', 0) == 0 || line.rfind('%', 0) == 0 || line.rfind("//", 0) == 0;
}

struct Line {
  int number = 0;  // from 1
  std::string text;
};

// The lines of a file, apart.
struct Parts {
  std::optional<Line> comment;  // the last before the rows
  std::vector<Line> rows;       // the first may be a header
};

Parts parts_of(const std::string& text) {
  Parts parts;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const Line line{++number, without_blanks(text.substr(at, end - at))};
    at = end + 1;
    if (line.text.empty()) continue;
    if (!is_comment(line.text)) {
      parts.rows.push_back(line);
    } else if (parts.rows.empty()) {
      parts.comment = line;
    }
  }
  return parts;
}

double number_of(const std::string& field, const std::string& file, int line, const std::string& name) {
  const auto number = io::parse_number(field);
  if (!number) throw ConfigError(file, line, name, "is " + field.substr(0, 60) + ", must be a finite number");
  return *number;
}

// Whether a column rises in steps that are equal to a tenth.
bool rises_evenly(const std::vector<Fields>& rows, std::size_t column) {
  if (rows.size() < 3) return false;
  std::vector<double> values;
  for (const Fields& row : rows) {
    const auto number = column < row.size() ? io::parse_number(row[column]) : std::nullopt;
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
Fields assumed_columns(const std::vector<Fields>& rows, const std::string& file, int line) {
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
std::string unit_of_stamps(const std::string& first) {
  const double stamp = std::abs(io::parse_number(first).value_or(0.0));
  return stamp >= 1e17 ? "ns" : stamp >= 1e14 ? "us" : stamp >= 1e11 ? "ms" : "";
}

int decimals_of_unit(const std::string& unit) { return unit == "ns" ? 9 : unit == "us" ? 6 : 3; }

// A stamp in ns, us or ms from the first one, in s, exactly: a double does not hold the ns since 1970.
std::string seconds_since(const std::string& first, const std::string& stamp, const std::string& unit) {
  std::int64_t a = 0;
  std::int64_t b = 0;
  const auto whole = [](const std::string& text, std::int64_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  };
  const int decimals = decimals_of_unit(unit);
  if (!whole(first, a) || !whole(stamp, b)) return stamp;
  return fmt::format("{:.{}f}", static_cast<double>(b - a) / std::pow(10.0, decimals), decimals);
}

class Writer {
 public:
  // foreign: units of SI may be dropped.
  Writer(std::vector<ForeignColumn> columns, const std::string& file, bool foreign)
      : columns_(std::move(columns)), file_(file) {
    static const Fields quaternion = {"qw", "qx", "qy", "qz"};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const ForeignColumn& column) {
        return column.name == quaternion[k];
      });
      quaternion_[k] = static_cast<std::size_t>(found - columns_.begin());
      turns_ = turns_ && found != columns_.end();
    }
    turns_ = turns_ && std::none_of(columns_.begin(), columns_.end(), [](const ForeignColumn& column) {
               return column.name.rfind("yaw", 0) == 0;
             });
    for (const ForeignColumn& column : columns_) {
      if (!column.name.empty() && !is_quaternion(column)) used_.push_back(column);
      if (column.name.empty()) left_out_.push_back(column.given);
    }
    static const Fields kOfSi = {"", "s", "m", "m/s", "m/s^2", "rad", "rad/s"};
    const bool plain = std::all_of(used_.begin(), used_.end(), [](const ForeignColumn& column) {
      return column.unit == "ns" || std::find(kOfSi.begin(), kOfSi.end(), column.unit) != kOfSi.end();
    });
    if (!foreign || !plain) return;
    for (ForeignColumn& column : used_) column.unit.clear();
  }

  bool has_units() const {
    return std::any_of(used_.begin(), used_.end(),
                       [](const ForeignColumn& column) { return !column.unit.empty(); });
  }
  void set_stamps(const std::string& first, std::string unit) {
    first_stamp_ = first;
    stamp_unit_ = std::move(unit);
    for (ForeignColumn& column : used_) {
      if (column.name == "t") column.unit = "";
    }
  }
  const std::string& stamp_unit() const { return stamp_unit_; }
  const Fields& left_out() const { return left_out_; }
  bool turns() const { return turns_; }

  Fields header() const {
    Fields names;
    for (const ForeignColumn& column : used_)
      names.push_back(column.name + unit_text(column.name, column.unit));
    if (turns_) names.push_back("yaw" + unit_text("yaw", ""));
    return names;
  }

  Fields row(const Fields& fields, int line) const {
    if (fields.size() != columns_.size())
      throw ConfigError(file_, line, "",
                        fmt::format("has {} fields, must have {}", fields.size(), columns_.size()));
    Fields out;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const ForeignColumn& column = columns_[i];
      if (column.name.empty() || is_quaternion(column)) continue;
      number_of(fields[i], file_, line, column.given);
      out.push_back(column.name == "t" && !stamp_unit_.empty()
                        ? seconds_since(first_stamp_, fields[i], stamp_unit_)
                        : fields[i]);
    }
    if (turns_) out.push_back(yaw_of(fields, line));
    return out;
  }

 private:
  static bool is_quaternion(const ForeignColumn& column) {
    return column.name.size() == 2 && column.name[0] == 'q';
  }

  // With units for all columns or for none.
  std::string unit_text(const std::string& name, const std::string& unit) const {
    if (!has_units()) return "";
    const char* const usual = name[0] == 't'                   ? "s"
                              : name.rfind("yaw_rate", 0) == 0 ? "rad/s"
                              : name.rfind("yaw", 0) == 0      ? "rad"
                              : name[0] == 'v'                 ? "m/s"
                              : name[0] == 'a'                 ? "m/s^2"
                                                               : "m";
    return " [" + (unit.empty() ? usual : unit) + "]";
  }

  // The yaw in the frame of the file, as text: the direction of body x, also for a vehicle that is tilted.
  std::string yaw_of(const Fields& fields, int line) const {
    std::array<double, 4> q{};
    for (std::size_t k = 0; k < 4; ++k)
      q[k] = number_of(fields[quaternion_[k]], file_, line, columns_[quaternion_[k]].given);
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::abs(length - 1.0) > 0.01)
      throw ConfigError(file_, line, "",
                        fmt::format("{}, {}, {}, {} are a quaternion of length {:.3f}, must be 1",
                                    columns_[quaternion_[0]].given, columns_[quaternion_[1]].given,
                                    columns_[quaternion_[2]].given, columns_[quaternion_[3]].given, length));
    const double yaw = std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
    const std::string& written = fields[quaternion_[3]];
    const std::size_t point = written.find('.');
    const std::size_t decimals = point == std::string::npos ? 3 : written.size() - point - 1;
    return fmt::format("{:.{}f}", yaw, std::clamp<std::size_t>(decimals, 3, 9));
  }

  std::vector<ForeignColumn> columns_;
  std::vector<ForeignColumn> used_;
  Fields left_out_;
  std::array<std::size_t, 4> quaternion_{};
  bool turns_ = true;  // the quaternion becomes a yaw
  std::string first_stamp_;
  std::string stamp_unit_;  // of stamps that become seconds since the first
  std::string file_;
};

bool is_header(const Fields& fields) { return !fields.empty() && !io::is_number(fields.front()); }

bool is_polynomial(const Fields& fields) { return lower(fields.front()) == "duration"; }

// A table in the dialect of this project, which its readers take as it is.
bool is_own(const Parts& parts, const std::string& text) {
  if (parts.rows.empty()) return true;
  const Fields first = split(parts.rows.front().text, ',');
  if (io::is_flight_csv(first)) return true;
  const bool dense = parts.rows.size() == static_cast<std::size_t>(parts.rows.back().number);
  if (!dense || text.find_first_of("#%") != std::string::npos || !is_header(first)) return false;
  return first.front() == "duration" || std::all_of(first.begin(), first.end(), is_known_column);
}

// Names of columns, in which line they stand, and the rows below.
struct Table {
  Fields header;
  int header_line = 0;  // 0: none
  std::vector<Line> lines;
  std::vector<Fields> rows;
};

Table table_of(const Parts& parts, const std::string& file, const std::string& columns, ForeignTable& out) {
  Table table;
  const char separator = separator_of(parts.rows.front().text);
  for (const Line& line : parts.rows) {
    if (separator == ';' && line.text.find(',') != std::string::npos)
      throw ConfigError(file, line.number, "", "has commas beside semicolons: numbers must have points");
    table.lines.push_back(line);
    table.rows.push_back(split(line.text, separator));
  }
  if (is_header(table.rows.front())) {
    table.header = table.rows.front();
    table.header_line = table.lines.front().number;
    table.rows.erase(table.rows.begin());
    table.lines.erase(table.lines.begin());
  } else if (parts.comment) {
    const std::string text =
        without_blanks(parts.comment->text.substr(parts.comment->text.find_first_not_of("#%/ \t")));
    const Fields names = split(text, separator_of(text));
    if (is_header(names) && names.size() == table.rows.front().size()) {
      table.header = names;
      table.header_line = parts.comment->number;
    }
  }
  if (!columns.empty()) {
    table.header = split(columns, ',');
    if (!table.rows.empty() && table.header.size() != table.rows.front().size())
      throw ConfigError(
          file, table.lines.front().number, "",
          fmt::format("has {} columns, --columns names {}", table.rows.front().size(), table.header.size()));
  } else if (table.header.empty()) {
    table.header = assumed_columns(table.rows, file, table.lines.front().number);
    out.assumptions.push_back("the file has no header: its columns are taken as " +
                              fmt::format("{}", fmt::join(table.header, ", ")));
  }
  return table;
}

// The header and the rows at their lines.
void write(ForeignTable& out, const Table& table, const Fields& header, const std::vector<Fields>& rows) {
  const int header_line = table.header_line > 0 ? table.header_line : table.lines.front().number - 1;
  out.first_line = std::min(header_line, 1);
  int line = out.first_line;
  const auto put = [&](int number, const std::string& text) {
    for (; line < number; ++line) out.text += '\n';
    out.text += text + '\n';
    ++line;
  };
  put(header_line, io::joined(header, ","));
  for (std::size_t i = 0; i < rows.size(); ++i) put(table.lines[i].number, io::joined(rows[i], ","));
}

}  // namespace

ForeignTable read_foreign_table(const std::string& text, const std::string& file_name,
                                const std::string& columns) {
  ForeignTable out;
  const Parts parts = parts_of(text);
  const auto as_it_is = [&] {
    out.text = text;
    return out;
  };
  if (columns.empty() && is_own(parts, text)) return as_it_is();
  const bool has_rows = std::any_of(parts.rows.begin(), parts.rows.end(), [](const Line& line) {
    return io::is_number(split(line.text, separator_of(line.text)).front());
  });
  if (!has_rows) return as_it_is();
  const Table table = table_of(parts, file_name, columns, out);
  if (is_polynomial(table.header)) {
    Fields header;
    for (const std::string& name : table.header) header.push_back(lower(name));
    write(out, table, header, table.rows);
    return out;
  }
  std::vector<ForeignColumn> named;
  for (const std::string& name : table.header)
    named.push_back(column_of(name, file_name, std::max(table.header_line, 1)));
  const bool foreign = std::any_of(table.header.begin(), table.header.end(),
                                   [](const std::string& name) { return !is_known_column(name); });
  Writer writer(std::move(named), file_name, foreign);
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    if (column_of(table.header[i], file_name, 1).name != "t") continue;
    const std::string unit = column_of(table.header[i], file_name, 1).unit;
    const std::string meant = unit.empty() ? unit_of_stamps(table.rows.front()[i]) : unit == "ns" ? unit : "";
    if (meant.empty()) continue;
    writer.set_stamps(table.rows.front()[i], meant);
    if (unit.empty()) out.assumptions.push_back("stamps are taken as " + meant);
  }
  std::vector<Fields> rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    rows.push_back(writer.row(table.rows[i], table.lines[i].number));
  if (foreign) {
    out.assumptions.push_back("the columns " + fmt::format("{}", fmt::join(table.header, ", ")) +
                              " are read as " + fmt::format("{}", fmt::join(writer.header(), ", ")) +
                              (writer.turns() ? ", the yaw from the quaternion" : ""));
  }
  if (!writer.left_out().empty())
    out.assumptions.push_back("not used: " + fmt::format("{}", fmt::join(writer.left_out(), ", ")));
  write(out, table, writer.header(), rows);
  return out;
}

}  // namespace swiftlet::io

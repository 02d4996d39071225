#include "swiftlet/io/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

constexpr std::size_t kMaxShownField = 60;

std::string shown_field(std::string_view text) {
  if (text.empty()) return "empty";
  std::string out;
  for (const char c : text.substr(0, kMaxShownField)) out += c >= 0x20 && c < 0x7f ? c : '?';
  if (text.size() > kMaxShownField) out += "...";
  return out;
}

std::vector<std::string_view> all_fields(std::string_view line, char separator = ',') {
  const std::string_view separators =
      separator == ' ' ? std::string_view(" \t") : std::string_view(&separator, 1);
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find_first_of(separators);
    fields.push_back(trimmed(line.substr(0, end)));
    if (separator == ' ' && fields.back().empty()) fields.pop_back();
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

bool read_number(std::string_view field, double& number) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, number);
  return error == std::errc() && stop == end && std::isfinite(number);
}

// Iterates over the lines of a text. An empty last line does not count.
class Lines {
 public:
  // first_line: of the text in the file. Throws ConfigError for control characters.
  Lines(std::string_view text, const std::string& file, int first_line = 1)
      : rest_(text), number_(first_line - 1) {
    const int line = line_of_control_character(text);
    if (line > 0)
      throw ConfigError(file, number_ + line, "", "is not a text file: it has control characters");
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest_.remove_prefix(kByteOrderMark.size());
  }

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return true;
  }
  int number() const { return number_; }
  bool only_blank_left() const { return rest_.find_first_not_of(" \t\r\n") == std::string_view::npos; }

 private:
  std::string_view rest_;
  int number_;
};

Table read_rows(Lines& lines, const std::string& file_name, const std::vector<std::string>& columns,
                std::size_t min_rows) {
  Table table(file_name, columns);
  std::string_view line;
  while (!lines.only_blank_left() && lines.next(line)) {
    std::vector<std::string_view> fields = all_fields(line);
    if (trimmed(line).empty()) fields.clear();
    table.add_row(lines.number(), fields);
  }
  table.require_rows(min_rows);
  return table;
}

}  // namespace

void require_header(const std::vector<std::string_view>& header, const std::vector<std::string>& columns,
                    const std::string& file_name, int line) {
  if (std::equal(header.begin(), header.end(), columns.begin(), columns.end())) return;
  if (is_number(header.front()))
    throw ConfigError(file_name, line, "", "has no header, the first line must be " + joined(columns, ","));
  throw ConfigError(
      file_name, line, "header",
      "is " + shown_field(joined({header.begin(), header.end()}, ",")) + ", must be " + joined(columns, ","));
}

void require_fields(const std::vector<std::string_view>& fields, const std::vector<std::string>& columns,
                    const std::string& file_name, int line) {
  if (fields.size() == columns.size()) return;
  throw ConfigError(file_name, line, "",
                    "has " + std::to_string(fields.size()) + " fields, must have " +
                        std::to_string(columns.size()) + ": " + joined(columns, ","));
}

double csv_number(std::string_view field, const std::string& column, const std::string& file_name, int line) {
  double number = 0.0;
  if (!read_number(field, number))
    throw ConfigError(file_name, line, column, "is " + shown_field(field) + ", must be a finite number");
  return number;
}

std::vector<double> csv_numbers(const std::vector<std::string_view>& fields,
                                const std::vector<std::string>& columns, const std::string& file_name,
                                int line) {
  require_fields(fields, columns, file_name, line);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < fields.size(); ++i)
    numbers.push_back(csv_number(fields[i], columns[i], file_name, line));
  return numbers;
}

Table parse_csv(std::string_view text, const std::string& file_name, const std::vector<std::string>& columns,
                std::size_t min_rows) {
  Lines lines(text, file_name);
  if (lines.only_blank_left())
    throw ConfigError(file_name, 0, "", "is empty, must begin with the header " + joined(columns, ","));
  std::string_view header;
  lines.next(header);
  require_header(all_fields(header), columns, file_name);
  return read_rows(lines, file_name, columns, min_rows);
}

Table parse_csv_as_headed(std::string_view text, const std::string& file_name, std::size_t min_rows) {
  Lines lines(text, file_name);
  std::string_view header;
  if (lines.only_blank_left()) throw ConfigError(file_name, 0, "", "is empty, must begin with a header");
  lines.next(header);
  std::vector<std::string> columns;
  for (const std::string_view name : all_fields(header)) {
    if (name.empty() || is_number(name))
      throw ConfigError(file_name, 1, "header", "is " + shown_field(header) + ", must name every column");
    columns.emplace_back(name);
  }
  if (columns.size() == 1 && columns.front().find_first_of(";\t") != std::string::npos) {
    throw ConfigError(file_name, 1, "header",
                      "has semicolons or tabs between its columns, must have commas, and points in numbers");
  }
  return read_rows(lines, file_name, columns, min_rows);
}

Table load_csv(const std::string& path, const std::vector<std::string>& columns, std::size_t min_rows) {
  return parse_csv(read_text_file(path), path, columns, min_rows);
}

std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file_name, int first_line) {
  Lines lines(text, file_name, first_line);
  std::vector<CsvLine> out;
  std::string_view line;
  while (lines.next(line)) {
    line = trimmed(line, " \t\r");
    if (!line.empty()) out.push_back({lines.number(), line});
  }
  return out;
}

std::vector<std::string_view> csv_fields(std::string_view line, std::size_t columns, char separator) {
  std::vector<std::string_view> fields = all_fields(line, separator);
  if (fields.size() > std::max<std::size_t>(columns, 1) && fields.back().empty()) fields.pop_back();
  return fields;
}

std::vector<std::string> first_csv_line(std::string_view text, const std::string& file_name) {
  const std::vector<CsvLine> lines = csv_lines(text, file_name);
  if (lines.empty()) return {};
  const std::vector<std::string_view> fields = csv_fields(lines.front().text);
  return {fields.begin(), fields.end()};
}

bool is_number(std::string_view field) { return parse_number(field).has_value(); }

std::optional<double> parse_number(std::string_view field) {
  double number = 0.0;
  if (!read_number(field, number)) return std::nullopt;
  return number;
}

std::string exact(double number) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), result.ptr};
}

}  // namespace swiftlet::io

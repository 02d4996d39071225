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

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::vector<std::string_view> fields_of(std::string_view line, const CsvForm& form) {
  std::vector<std::string_view> fields = fields_of(line);
  if (form.may_end_with_comma && fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return fields;
}

bool read_number(std::string_view field, double& number) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, number);
  return error == std::errc() && stop == end && std::isfinite(number);
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  return text;
}

// Iterates over the lines of a text. An empty last line does not count.
class Lines {
 public:
  // first_line: that of the text in the file
  explicit Lines(std::string_view text, int first_line = 1) : rest_(text), number_(first_line - 1) {}

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

// first_line: that of the text in the file
void require_text(std::string_view text, const std::string& file, int first_line = 1) {
  const int line = line_of_control_character(text);
  if (line > 0)
    throw ConfigError(file, first_line + line - 1, "", "is not a text file: it has control characters");
}

void check_header(std::string_view line, const std::string& file, const std::vector<std::string>& columns,
                  const CsvForm& form) {
  const std::vector<std::string_view> names = fields_of(line, form);
  double number = 0.0;
  if (read_number(names.front(), number)) {
    throw ConfigError(file, 1, "", "has no header, the first line must be " + joined(columns, ","));
  }
  if (names.size() == columns.size()) {
    std::size_t i = 0;
    while (i < names.size() && names[i] == columns[i]) ++i;
    if (i == names.size()) return;
  }
  throw ConfigError(file, 1, "header", "is " + shown_field(line) + ", must be " + joined(columns, ","));
}

CsvTable read_rows(Lines& lines, const std::string& file_name, const std::vector<std::string>& columns,
                   std::size_t min_rows, const CsvForm& form) {
  if (columns.size() == 1 && columns.front().find_first_of(";\t") != std::string::npos) {
    throw ConfigError(file_name, 1, "header",
                      "has semicolons or tabs between its columns, must have commas, and points in numbers");
  }
  CsvTable table(file_name, columns);
  std::string_view line;
  std::vector<double> numbers(columns.size());
  while (!lines.only_blank_left() && lines.next(line)) {
    if (form.may_have_blank_lines && trimmed(line).empty()) continue;
    const std::vector<std::string_view> fields = fields_of(line, form);
    if (fields.size() != columns.size()) {
      throw ConfigError(file_name, lines.number(), "",
                        "has " + std::to_string(trimmed(line).empty() ? 0 : fields.size()) +
                            " fields, must have " + std::to_string(columns.size()) + ": " +
                            joined(columns, ","));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (!read_number(fields[i], numbers[i])) {
        throw ConfigError(file_name, lines.number(), columns[i],
                          "is " + shown_field(fields[i]) + ", must be a finite number");
      }
    }
    table.add_row(lines.number(), numbers, fields);
  }
  if (table.row_count() < min_rows) {
    throw ConfigError(file_name, 0, "",
                      "has " + std::to_string(table.row_count()) +
                          (form.has_header ? " rows behind the header" : " rows") + ", must have at least " +
                          std::to_string(min_rows));
  }
  return table;
}

}  // namespace

void CsvTable::add_row(int line, const std::vector<double>& numbers,
                       const std::vector<std::string_view>& fields) {
  lines_.push_back(line);
  numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < fields.size(); ++i) digits_[i].add(fields[i]);
}

void CsvTable::Digits::add(std::string_view number) {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  std::string_view exponent = number.substr(std::min(exponent_at + 1, number.size()));
  int point_shift = 0;
  if (!exponent.empty() && exponent.front() == '+') exponent.remove_prefix(1);
  std::from_chars(exponent.data(), exponent.data() + exponent.size(), point_shift);
  int behind_point = 0;
  int counted = 0;
  bool point = false;
  for (const char c : number.substr(0, exponent_at)) {
    if (c == '.') point = true;
    if (c < '0' || c > '9') continue;
    if (point) ++behind_point;
    if (counted > 0 || c != '0') ++counted;
  }
  decimals = std::max(decimals, behind_point - point_shift);
  significant = std::max(significant, counted);
}

double CsvTable::last_digit(std::size_t row, std::size_t column) const {
  const Digits& digits = digits_[column];
  const double value = std::abs(numbers_[row * columns_.size() + column]);
  int decimals = digits.decimals;
  if (value > 0.0)
    decimals = std::min(decimals, digits.significant - 1 - static_cast<int>(std::floor(std::log10(value))));
  return std::pow(10.0, -decimals);
}

double CsvTable::number(std::size_t row, std::size_t column, const Bounds& bounds, const char* unit) const {
  const double value = numbers_[row * columns_.size() + column];
  if (!bounds.contains(value)) {
    fail(row, columns_[column],
         "is " + exact(value) + ", must be " + bounds.to_string() + (*unit == '\0' ? "" : " ") + unit);
  }
  return value;
}

void CsvTable::fail(std::size_t row, const std::string& columns, const std::string& message) const {
  throw ConfigError(file_, lines_[row], columns, message);
}

CsvTable parse_csv(std::string_view text, const std::string& file_name,
                   const std::vector<std::string>& columns, std::size_t min_rows, const CsvForm& form) {
  require_text(text, file_name, form.first_line);
  Lines lines(without_byte_order_mark(text), form.first_line);
  std::string_view line;
  if (lines.only_blank_left()) {
    throw ConfigError(file_name, 0, "",
                      std::string("is empty, must ") +
                          (form.has_header ? "begin with the header " : "hold rows of ") +
                          joined(columns, ","));
  }
  if (form.has_header) {
    do {
      lines.next(line);
    } while (form.may_have_blank_lines && trimmed(line).empty());
    check_header(line, file_name, columns, form);
  }
  return read_rows(lines, file_name, columns, min_rows, form);
}

CsvTable parse_csv_as_headed(std::string_view text, const std::string& file_name, std::size_t min_rows) {
  require_text(text, file_name);
  Lines lines(without_byte_order_mark(text));
  std::string_view header;
  if (lines.only_blank_left()) throw ConfigError(file_name, 0, "", "is empty, must begin with a header");
  lines.next(header);
  std::vector<std::string> columns;
  for (const std::string_view name : fields_of(header)) {
    double number = 0.0;
    if (name.empty() || read_number(name, number))
      throw ConfigError(file_name, 1, "header", "is " + shown_field(header) + ", must name every column");
    columns.emplace_back(name);
  }
  return read_rows(lines, file_name, columns, min_rows, {});
}

CsvTable load_csv(const std::string& path, const std::vector<std::string>& columns, std::size_t min_rows) {
  return parse_csv(read_text_file(path), path, columns, min_rows);
}

std::vector<std::string> first_csv_line(std::string_view text, const std::string& file_name, int first_line) {
  require_text(text, file_name, first_line);
  Lines lines(without_byte_order_mark(text));
  std::string_view line;
  while (lines.next(line)) {
    if (trimmed(line).empty()) continue;
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() == 1 && line.find(';') != std::string_view::npos)
      throw ConfigError(file_name, first_line, "", "is separated by semicolons, must be separated by commas");
    return {fields.begin(), fields.end()};
  }
  return {};
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

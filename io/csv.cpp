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

bool has_decimal_point(std::string_view line) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 1; i < line.size(); ++i) {
    if ((line[i] == '.' && is_digit(line[i - 1])) || (line[i - 1] == '.' && is_digit(line[i]))) return true;
  }
  return false;
}

// UTF-8 with LF at the ends of lines and blanks where the text has no-break spaces.
std::string with_plain_blanks(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  const auto skip = [&text](std::string_view characters) {
    const bool found = text.substr(0, characters.size()) == characters;
    if (found) text.remove_prefix(characters.size());
    return found;
  };
  skip("\xef\xbb\xbf");
  while (true) {
    const std::size_t plain = std::min(text.find_first_of("\r\xc2\xe2"), text.size());
    out += text.substr(0, plain);
    text.remove_prefix(plain);
    if (text.empty()) return out;
    if (skip("\r\n") || skip("\r")) {
      out += '\n';
    } else if (skip("\xc2\xa0") || skip("\xe2\x80\xaf")) {
      out += ' ';
    } else {
      out += text.front();
      text.remove_prefix(1);
    }
  }
}

// A line with commas between its columns, without the quotes around them. Commas in numbers become points where
// another separator stands between columns, or quotes around them.
std::string with_commas(std::string_view line, char separator) {
  std::string out;
  bool quoted = false;
  bool at_start = true;  // of a field
  for (const char c : line) {
    if (c == '"' && (at_start || quoted)) {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      out += ',';
    } else {
      out += c == ',' ? '.' : c;
    }
    at_start = (at_start && c == ' ') || (c == separator && !quoted);
  }
  return out;
}

// What separates the columns: blanks count as a comma, since only missions have such tables.
char separator_in(const std::vector<CsvLine>& lines) {
  const auto first =
      std::find_if(lines.begin(), lines.end(), [](const CsvLine& l) { return !is_comment(l.text); });
  if (first == lines.end()) return ',';
  if (first->text.find(';') != std::string::npos) return ';';
  return first->text.find(',') == std::string::npos && first->text.find('\t') != std::string::npos ? '\t'
                                                                                                   : ',';
}

// Throws ConfigError for commas and points in numbers: one of them could separate thousands.
void refuse_two_points(const std::vector<CsvLine>& lines, const std::string& file, char separator) {
  const auto has_comma = [](const CsvLine& l) {
    return !is_comment(l.text) && l.text.find(',') != std::string::npos;
  };
  const auto comma = std::find_if(lines.begin(), lines.end(), has_comma);
  const bool points = std::any_of(lines.begin() + 1, lines.end(), [](const CsvLine& l) {
    return !is_comment(l.text) && has_decimal_point(l.text);
  });
  if (comma == lines.end() || !points) return;
  throw ConfigError(file, comma->number, "",
                    std::string("has commas beside ") + (separator == ';' ? "semicolons" : "tabs") +
                        ": numbers must have points");
}

Table read_rows(const std::vector<CsvLine>& lines, const std::string& file_name,
                const std::vector<std::string>& columns, std::size_t min_rows) {
  Table table(file_name, columns);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const int next = lines[i - 1].number + 1;
    if (lines[i].number > next) table.add_row(next, {});  // a blank line, which is refused
    table.add_row(lines[i].number, csv_fields(lines[i].text, columns.size()));
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
    throw ConfigError(file_name, line, column,
                      "is " + shown_field(field) + ", must be a finite number" + typography_in(field));
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
  const std::vector<CsvLine> lines = csv_lines(text, file_name);
  if (lines.empty())
    throw ConfigError(file_name, 0, "", "is empty, must begin with the header " + joined(columns, ","));
  require_header(all_fields(lines.front().text), columns, file_name, lines.front().number);
  return read_rows(lines, file_name, columns, min_rows);
}

Table parse_csv_as_headed(std::string_view text, const std::string& file_name, std::size_t min_rows) {
  const std::vector<CsvLine> lines = csv_lines(text, file_name);
  if (lines.empty()) throw ConfigError(file_name, 0, "", "is empty, must begin with a header");
  const std::string& header = lines.front().text;
  std::vector<std::string> columns;
  for (const std::string_view name : all_fields(header)) {
    if (name.empty() || is_number(name))
      throw ConfigError(file_name, lines.front().number, "header",
                        "is " + shown_field(header) + ", must name every column");
    columns.emplace_back(name);
  }
  return read_rows(lines, file_name, columns, min_rows);
}

Table load_csv(const std::string& path, const std::vector<std::string>& columns, std::size_t min_rows) {
  return parse_csv(read_text_file(path), path, columns, min_rows);
}

std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file_name, int first_line) {
  refuse_utf16(text, file_name);
  const std::string plain = with_plain_blanks(text);
  if (const int line = line_of_control_character(plain); line > 0)
    throw ConfigError(file_name, first_line - 1 + line, "", "is not a text file: it has control characters");
  std::vector<CsvLine> lines;
  int number = first_line;
  for (std::size_t at = 0; at < plain.size(); ++number) {
    const std::size_t end = std::min(plain.find('\n', at), plain.size());
    const std::string_view line = trimmed(std::string_view(plain).substr(at, end - at));
    const bool names_separator = number == first_line && line.size() == 5 && line.substr(0, 4) == "sep=";
    if (!line.empty() && !names_separator) lines.push_back({number, std::string(line)});
    at = end + 1;
  }
  const char separator = separator_in(lines);
  if (separator != ',') refuse_two_points(lines, file_name, separator);
  for (CsvLine& line : lines) {
    const bool is_plain = separator == ',' && line.text.find('"') == std::string::npos;
    if (!is_plain && !is_comment(line.text)) line.text = with_commas(line.text, separator);
  }
  return lines;
}

std::vector<std::string_view> csv_fields(std::string_view line, std::size_t columns, char separator) {
  std::vector<std::string_view> fields = all_fields(line, separator);
  if (fields.size() > std::max<std::size_t>(columns, 1) && fields.back().empty()) fields.pop_back();
  return fields;
}

std::vector<std::string> first_csv_line(std::string_view text, const std::string& file_name) {
  constexpr std::size_t kLongestHeader = std::size_t{1} << 16;
  const std::vector<CsvLine> lines = csv_lines(text.substr(0, kLongestHeader), file_name);
  if (lines.empty()) return {};
  const std::vector<std::string_view> fields = csv_fields(lines.front().text);
  return {fields.begin(), fields.end()};
}

bool is_comment(std::string_view line) {
  return line.front() == '#' || line.front() == '%' || line.substr(0, 2) == "//";
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

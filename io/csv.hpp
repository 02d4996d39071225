// CSV tables of numbers. Any invalid input throws ConfigError with file, line, column, value and limit.
//
// Tables of Excel, R, pandas and others are read as what they mean, by all readers alike: with a byte order mark, a line
// "sep=;", lines that end with LF, CRLF or CR, no-break spaces, quotes around fields, semicolons or tabs between the
// columns, and then also with commas in the numbers. Blanks around a field are ignored. Comments are for missions only
// (missions/mission_table.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/io/table.hpp"

namespace swiftlet::io {

// Reads a table of exactly these columns, in this order, with at least min_rows rows. file_name appears in
// messages only.
Table parse_csv(std::string_view text, const std::string& file_name, const std::vector<std::string>& columns,
                std::size_t min_rows = 1);
Table load_csv(const std::string& path, const std::vector<std::string>& columns, std::size_t min_rows = 1);
// Reads a table with any column names in its header, at least one.
Table parse_csv_as_headed(std::string_view text, const std::string& file_name, std::size_t min_rows = 1);

// A line that is not blank, without the blanks at both ends, with commas between the columns and points in numbers. Only
// columns that blanks separate keep them.
struct CsvLine {
  int number = 0;  // in the file, from 1
  std::string text;
};
// first_line: of the text in the file. Throws ConfigError for control characters, UTF-16, and for commas and points in
// numbers.
std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file_name, int first_line = 1);

// The fields of a line of a table with so many columns. An empty one after the separator behind the last column is
// none. separator ' ': any number of blanks and tabs.
std::vector<std::string_view> csv_fields(std::string_view line, std::size_t columns = 1,
                                         char separator = ',');

// The fields of the first line; empty if there is none.
std::vector<std::string> first_csv_line(std::string_view text, const std::string& file_name);

// The numbers of a row. Throws ConfigError unless it has a finite number for each column.
std::vector<double> csv_numbers(const std::vector<std::string_view>& fields,
                                const std::vector<std::string>& columns, const std::string& file_name,
                                int line);
void require_fields(const std::vector<std::string_view>& fields, const std::vector<std::string>& columns,
                    const std::string& file_name, int line);
double csv_number(std::string_view field, const std::string& column, const std::string& file_name, int line);
// Throws ConfigError unless a header is that of these columns.
void require_header(const std::vector<std::string_view>& header, const std::vector<std::string>& columns,
                    const std::string& file_name, int line = 1);

bool is_comment(std::string_view line);                      // of a line that is not blank
bool is_number(std::string_view field);                      // true for a finite number
std::optional<double> parse_number(std::string_view field);  // nothing if it is no finite number

// The shortest decimal that reads back as the same number.
std::string exact(double number);

}  // namespace swiftlet::io

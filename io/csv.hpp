// Strict reader of CSV tables of numbers: one header line that names every column, then rows of finite
// numbers. Any other input throws ConfigError with file, line, column, value and limit.
//
//   const CsvTable table = load_csv("pwm.csv", {"t", "pwm1", "pwm2"});
//   for (std::size_t row = 0; row < table.row_count(); ++row) {
//     use(table.number(row, 0), table.number(row, 1, between(1000, 2000)));
//   }
//
// Lines end with LF or CRLF; the last line may lack it. Blanks around a field are ignored. Quotes and
// comments are not supported. CsvForm lists the accepted variations of files from other tools.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/io/config.hpp"

namespace swiftlet::io {

class CsvTable {
 public:
  CsvTable(std::string file, std::vector<std::string> columns)
      : file_(std::move(file)), columns_(std::move(columns)), digits_(columns_.size()) {}

  std::size_t row_count() const { return lines_.size(); }
  std::size_t column_count() const { return columns_.size(); }

  // Throws ConfigError if the number is out of bounds. unit appears in the message only.
  double number(std::size_t row, std::size_t column, const Bounds& bounds = any_number(),
                const char* unit = "") const;

  std::vector<double> row(std::size_t row) const {
    const auto begin = numbers_.begin() + static_cast<std::ptrdiff_t>(row * columns_.size());
    return {begin, begin + static_cast<std::ptrdiff_t>(columns_.size())};
  }

  // The value of the last digit with which the number is written: 0.001 if the numbers of the column have up to three
  // decimals. Where they have as many significant digits instead, it depends on the number: 0.01 for 123.45 beside
  // 1.2345.
  double last_digit(std::size_t row, std::size_t column) const;

  // Throws ConfigError for this row. columns names the affected columns; message reads like "is 3, must be
  // below 2".
  [[noreturn]] void fail(std::size_t row, const std::string& columns, const std::string& message) const;

  const std::string& file() const { return file_; }
  const std::string& column(std::size_t column) const { return columns_[column]; }
  const std::vector<std::string>& columns() const { return columns_; }
  int line(std::size_t row) const { return lines_[row]; }  // from 1, which is the header

  // fields: the numbers as they are written.
  void add_row(int line, const std::vector<double>& numbers, const std::vector<std::string_view>& fields);

 private:
  // The most digits of the numbers of a column.
  struct Digits {
    int decimals = std::numeric_limits<int>::min();
    int significant = 1;

    void add(std::string_view number);
  };

  std::string file_;
  std::vector<std::string> columns_;
  std::vector<int> lines_;
  std::vector<double> numbers_;  // row by row
  std::vector<Digits> digits_;   // of each column
};

struct CsvForm {
  bool has_header = true;
  bool may_end_with_comma = false;  // every line, including the header
  bool may_have_blank_lines = false;
  int first_line = 1;  // of the text in the file
};

// Reads a table of exactly these columns, in this order, with at least min_rows rows. file_name appears in
// messages only.
CsvTable parse_csv(std::string_view text, const std::string& file_name,
                   const std::vector<std::string>& columns, std::size_t min_rows = 1,
                   const CsvForm& form = {});
CsvTable load_csv(const std::string& path, const std::vector<std::string>& columns, std::size_t min_rows = 1);

// The fields of the first non-blank line; empty if there is none. file_name and first_line, the line of the text
// in the file, appear in messages only. Throws ConfigError for control characters.
std::vector<std::string> first_csv_line(std::string_view text, const std::string& file_name,
                                        int first_line = 1);
bool is_number(std::string_view field);                      // true for a finite number
std::optional<double> parse_number(std::string_view field);  // nothing if it is no finite number
// Reads a table with any column names in its header, at least one.
CsvTable parse_csv_as_headed(std::string_view text, const std::string& file_name, std::size_t min_rows = 1);

// The shortest decimal that reads back as the same number.
std::string exact(double number);

}  // namespace swiftlet::io

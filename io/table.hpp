// A table of numbers: named columns, and in which line of a file each row stands. Readers of missions, of measurements
// and of logs return one. The header of a column may state frame and unit, such as "x_ned [m]" (column.hpp).
//
//   for (std::size_t row = 0; row < table.row_count(); ++row) {
//     use(table.number(row, 0), table.number(row, 1, between(1000, 2000)));
//   }
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/io/config.hpp"

namespace swiftlet::io {

class Table {
 public:
  Table(std::string file, std::vector<std::string> columns)
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
  // Throws ConfigError unless there are as many rows.
  void require_rows(std::size_t least) const;

  const std::string& file() const { return file_; }
  const std::string& column(std::size_t column) const { return columns_[column]; }
  const std::vector<std::string>& columns() const { return columns_; }
  int line(std::size_t row) const { return lines_[row]; }  // from 1, which is the header

  // Adds a row as it is written. Throws ConfigError unless it has a finite number for each column.
  void add_row(int line, const std::vector<std::string_view>& fields);
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

}  // namespace swiftlet::io

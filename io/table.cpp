#include "swiftlet/io/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "swiftlet/io/csv.hpp"

namespace swiftlet::io {

void Table::add_row(int line, const std::vector<std::string_view>& fields) {
  add_row(line, csv_numbers(fields, columns_, file_, line), fields);
}

void Table::add_row(int line, const std::vector<double>& numbers,
                    const std::vector<std::string_view>& fields) {
  lines_.push_back(line);
  numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < fields.size(); ++i) digits_[i].add(fields[i]);
}

void Table::Digits::add(std::string_view number) {
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

double Table::last_digit(std::size_t row, std::size_t column) const {
  const Digits& digits = digits_[column];
  const double value = std::abs(numbers_[row * columns_.size() + column]);
  int decimals = digits.decimals;
  if (value > 0.0)
    decimals = std::min(decimals, digits.significant - 1 - static_cast<int>(std::floor(std::log10(value))));
  return std::pow(10.0, -decimals);
}

double Table::number(std::size_t row, std::size_t column, const Bounds& bounds, const char* unit) const {
  const double value = numbers_[row * columns_.size() + column];
  if (!bounds.contains(value)) {
    fail(row, columns_[column],
         "is " + exact(value) + ", must be " + bounds.to_string() + (*unit == '\0' ? "" : " ") + unit);
  }
  return value;
}

void Table::fail(std::size_t row, const std::string& columns, const std::string& message) const {
  throw ConfigError(file_, lines_[row], columns, message);
}

void Table::require_rows(std::size_t least) const {
  if (row_count() >= least) return;
  const bool has_header = lines_.empty() || lines_.front() > 1;
  throw ConfigError(file_, 0, "",
                    "has " + std::to_string(row_count()) +
                        (has_header ? " rows behind the header" : " rows") + ", must have at least " +
                        std::to_string(least));
}

}  // namespace swiftlet::io

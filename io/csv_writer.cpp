#include "swiftlet/io/csv_writer.hpp"

#include <cerrno>
#include <stdexcept>

#include <fmt/format.h>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/csv.hpp"

namespace swiftlet::io {

CsvWriter::CsvWriter(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : path_(file), file_(std::fopen(unfinished_name(file).c_str(), "w")) {
  if (!file_) throw std::runtime_error(write_fault(path_, errno));
  for (const std::string& column : columns) text(column);
  end_row();
}

void CsvWriter::separate() {
  if (!first_) row_ += ',';
  first_ = false;
}

CsvWriter& CsvWriter::number(double value, int significant_digits) {
  separate();
  row_ += fmt::format("{:.{}g}", value, significant_digits);
  return *this;
}

CsvWriter& CsvWriter::fixed(double value, int decimals) {
  separate();
  row_ += fmt::format("{:.{}f}", value, decimals);
  return *this;
}

CsvWriter& CsvWriter::exact(double value) {
  separate();
  row_ += io::exact(value);
  return *this;
}

CsvWriter& CsvWriter::text(const std::string& value) {
  if (value.find_first_of(",\"\r\n") != std::string::npos) return quoted(value);
  separate();
  row_ += value;
  return *this;
}

CsvWriter& CsvWriter::quoted(const std::string& value) {
  separate();
  row_ += '"';
  for (const char c : value) row_ += c == '"' ? std::string("\"\"") : std::string(1, c);
  row_ += '"';
  return *this;
}

CsvWriter& CsvWriter::empty(int cells) {
  for (int i = 0; i < cells; ++i) separate();
  return *this;
}

void CsvWriter::end_row() {
  row_ += '\n';
  if (std::fputs(row_.c_str(), file_.get()) < 0 && error_ == 0) error_ = errno;
  row_.clear();
  first_ = true;
}

void CsvWriter::finish() {
  if (std::fflush(file_.get()) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) throw std::runtime_error(write_fault(path_, error_));
  finish_file(path_);
}

}  // namespace swiftlet::io

// Writes a CSV table, cell by cell. The file is called NAME.part until it is finished; a table that is never
// finished keeps that name.
//
//   CsvWriter csv("path.csv", {"t", "x", "y"});
//   csv.fixed(0.01, 6).number(1.5).number(-2.0).end_row();
//   csv.finish();
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace swiftlet::io {

class CsvWriter {
 public:
  // Writes the header line. Throws std::runtime_error if the file cannot be opened.
  CsvWriter(const std::filesystem::path& file, const std::vector<std::string>& columns);

  CsvWriter& number(double value, int significant_digits = 9);
  template <class Values>
  CsvWriter& numbers(const Values& values) {
    for (const double value : values) number(value);
    return *this;
  }
  CsvWriter& fixed(double value, int decimals);
  CsvWriter& exact(double value);               // the shortest decimal that reads back as the same number
  CsvWriter& text(const std::string& value);    // quoted if it needs to be (RFC 4180)
  CsvWriter& quoted(const std::string& value);  // always quoted
  CsvWriter& empty(int cells = 1);
  void end_row();

  // Gives the file its name. Throws std::runtime_error if a row could not be written. Call it last: errors are
  // reported here only.
  void finish();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void separate();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::string row_;
  bool first_ = true;
  int error_ = 0;  // errno of the first row that could not be written
};

}  // namespace swiftlet::io

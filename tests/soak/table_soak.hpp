// A soak whose flights are the rows of a table: --first and --last choose some of them.
#pragma once

#include <cstddef>
#include <functional>

#include "swiftlet/services/runtime/process.hpp"

namespace swiftlet::soak {

// The main function of such a soak. header: prints the names of the columns. fly_row: flies one of the `rows`, prints it,
// and returns whether it went as the table says. Returns 1 if a row did not, otherwise as runtime::run_process().
inline int run_table_soak(const runtime::ProgramText& text, int argc, char** argv, std::size_t rows,
                          const std::function<void()>& header,
                          const std::function<bool(std::size_t row)>& fly_row) {
  std::size_t first = 0;
  std::size_t last = 1000;
  bool all_as_expected = true;
  const int status = runtime::run_process(
      text, argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--first", first, "number of the first row").range(0, 1000).show_default();
        app.add_option("--last", last, "number of the last row").range(0, 1000);
      },
      [&] {
        header();
        for (std::size_t row = first; row <= last && row < rows; ++row) {
          if (!fly_row(row)) all_as_expected = false;
        }
      });
  return status == 0 && !all_as_expected ? 1 : status;
}

}  // namespace swiftlet::soak

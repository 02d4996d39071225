// Columns of numbers in a page: compressed, as text. assets/columns.js reads them.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::pages {

// The numbers in single precision: their bytes by significance (all first bytes, then all second ones ...), as zlib
// stream, in Base64.
std::string packed(const std::vector<double>& numbers);

// Ascending times, s: the differences in microseconds, from 0 at `start_s`, as 32-bit integers packed as above. No
// difference may exceed 4294 s.
std::string packed_times(const std::vector<double>& times_s, double start_s);

}  // namespace swiftlet::pages

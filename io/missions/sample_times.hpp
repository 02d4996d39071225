// The stamps of a sampled trajectory: their rate, and what is irregular about them.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/io/table.hpp"

namespace swiftlet::io {

struct SampleTimes {
  std::vector<double> time_s;  // of each row, from 0; rising
  double step_s = 0.0;         // usual step, the median
  double rounding_s = 0.0;     // by how much stamps may be off: half of their last digit; 0 if they are even
  std::vector<std::string> remarks;  // gaps and jitter, with their lines; whether rounding was undone

  std::string rate() const;  // "100 Hz", "0.5 Hz"
};

// column: that of the stamps; factor: from its unit to s. Stamps that are even but for the rounding of their
// last digit become even. Throws io::ConfigError with the line of a stamp that repeats, decreases or comes
// more than an hour after the one before.
SampleTimes sample_times(const Table& table, std::size_t column, double factor);

}  // namespace swiftlet::io

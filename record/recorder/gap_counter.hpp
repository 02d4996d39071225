// Counts samples that were sent and did not arrive.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace swiftlet::record {

class GapCounter {
 public:
  // Returns how many samples of this writer are missing before this one. Samples before the first are not counted.
  std::uint64_t missing_before(std::uint64_t writer, std::uint64_t sequence_number) {
    const auto known =
        std::find_if(last_.begin(), last_.end(), [&](const Last& last) { return last.writer == writer; });
    if (known == last_.end()) {
      last_.push_back({writer, sequence_number});
      return 0;
    }
    if (sequence_number <= known->sequence_number) return 0;  // sent again
    const std::uint64_t missing = sequence_number - known->sequence_number - 1;
    known->sequence_number = sequence_number;
    return missing;
  }

 private:
  struct Last {
    std::uint64_t writer;
    std::uint64_t sequence_number;
  };

  std::vector<Last> last_;
};

}  // namespace swiftlet::record

// The columns of a message that are one signal: "position_ned[0]", "position_ned[1]" and "position_ned[2]".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/message_decoder.hpp"

namespace swiftlet::mcap {

struct SignalArray {
  std::string name;  // "position_ned"
  std::size_t first = 0;
  std::size_t count = 1;
  Column::Kind kind = Column::Kind::kFloat;
};

inline std::vector<SignalArray> signal_arrays(const std::vector<Column>& columns) {
  std::vector<SignalArray> arrays;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& name = columns[i].name;
    const bool indexed = name.back() == ']' && columns[i].kind != Column::Kind::kText;
    const std::string base = indexed ? name.substr(0, name.rfind('[')) : name;
    if (indexed && !arrays.empty() && arrays.back().name == base && name != base + "[0]") {
      ++arrays.back().count;
    } else {
      arrays.push_back({base, i, 1, columns[i].kind});
    }
  }
  return arrays;
}

}  // namespace swiftlet::mcap

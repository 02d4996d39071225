// Lists as text.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::runtime {

// The parts between the separators, also empty ones: one more than there are separators.
inline std::vector<std::string> split_text(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(separator); end != std::string::npos; end = text.find(separator, begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

}  // namespace swiftlet::runtime

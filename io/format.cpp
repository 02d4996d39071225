#include "swiftlet/io/format.hpp"

#include <cstdarg>
#include <cstdio>

namespace swiftlet::ground {

std::string format(const char* pattern, ...) {
  char buffer[256];
  std::va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(buffer, sizeof buffer, pattern, arguments);
  va_end(arguments);
  return buffer;
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace swiftlet::ground

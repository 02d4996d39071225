// Formats counts for messages.
#pragma once

#include <cstddef>
#include <string>

namespace swiftlet::io {

// "1 flight", "2 flights". The plural of the noun must end in -s.
std::string counted(std::size_t count, const std::string& noun);

}  // namespace swiftlet::io

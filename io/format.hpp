// Texts of numbers.
#pragma once

#include <cstddef>
#include <string>

namespace swiftlet::ground {

// "1 flight", "2 flights"; of a noun whose plural ends with -s.
std::string counted(std::size_t count, const std::string& noun);

}  // namespace swiftlet::ground

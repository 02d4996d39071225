// Texts of numbers.
#pragma once

#include <cstddef>
#include <string>

namespace swiftlet::ground {

// printf, cut after 255 characters.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

// "1 flight", "2 flights"; of a noun whose plural ends with -s.
std::string counted(std::size_t count, const std::string& noun);

}  // namespace swiftlet::ground

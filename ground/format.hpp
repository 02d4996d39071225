// printf into a text.
#pragma once

#include <string>

namespace swiftlet::ground {

// Cut after 255 characters.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

}  // namespace swiftlet::ground

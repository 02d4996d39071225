// The order in which people count: "kl2" before "kl10".
#pragma once

#include <string_view>

namespace swiftlet::io {

// Whether a comes before b. Digits in a row are compared as a number, all else by character; a strict order of all texts.
bool comes_before(std::string_view a, std::string_view b);

}  // namespace swiftlet::io

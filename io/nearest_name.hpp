// The name that a misspelt one probably means.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::io {

// The nearest of the names by edit distance, if `wanted` differs from it by few letters or is its beginning;
// else "".
std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted);

// " Did you mean 'hold_s'?", to follow a sentence; "" if no name is near.
std::string did_you_mean(const std::vector<std::string>& names, const std::string& wanted);
// "; nearest is hold_s", to follow a list in a sentence; "" if no name is near.
std::string or_nearest(const std::vector<std::string>& names, const std::string& wanted);

}  // namespace swiftlet::io

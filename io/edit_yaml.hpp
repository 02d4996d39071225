// Changes values in a YAML text, and keeps its comments and its layout.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace swiftlet::io {

// Each pair is a key such as "position.x.omega_n" or "attitude.roll.q[0]", and the text of its new value. Throws
// ConfigError if the text is not valid YAML, the key is missing or has no scalar, or two keys share one by an alias.
std::string with_scalars(const std::string& text, const std::string& file_name,
                         const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace swiftlet::io

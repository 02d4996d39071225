// Flattens a YAML text to a list of key-value pairs, for comparing files.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace swiftlet::io {

// Returns pairs such as "position.x.omega_n" -> "2.0", in the order of the text. The elements of a list have
// the keys key[0], key[1], ...; a list of scalars is one pair with the value "[1, 2, 3]". Values are as
// written. Throws ConfigError with file and line for invalid YAML.
std::vector<std::pair<std::string, std::string>> flatten_yaml(std::string_view text,
                                                              const std::string& file_name);

}  // namespace swiftlet::io

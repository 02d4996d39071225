// A YAML text as a list of single settings, to compare files by.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace swiftlet::runtime {

// "position.x.omega_n" -> "2.0", in the order of the text; elements of a list are key[0], key[1] ... , but a
// list of plain values stays one setting, "[1, 2, 3]". Values are as written. Throws ConfigError, with file
// and line, for what is no YAML.
std::vector<std::pair<std::string, std::string>> flatten_yaml(std::string_view text,
                                                              const std::string& file_name);

}  // namespace swiftlet::runtime

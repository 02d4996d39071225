// The columns of foreign tables: what their names mean.
#pragma once

#include <string>

namespace swiftlet::io {

std::string without_blanks(const std::string& text);  // at both ends

// A column of a foreign table.
struct ForeignColumn {
  std::string name;  // of motion_columns.hpp, "qw" ... "qz", or empty: it is left out
  std::string unit;  // empty: that of SI
  std::string given;
};

// Throws ConfigError for a name that is not known. line: of the header.
ForeignColumn column_of(const std::string& given, const std::string& file, int line);

// True for the name of a column in the dialect of this project, also with a frame or a unit.
bool is_known_column(const std::string& header);

}  // namespace swiftlet::io

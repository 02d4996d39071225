// Reads a complete input file, and shows text from it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace swiftlet::io {

// Throws ConfigError "FILE: cannot be read: REASON", or "is too large" if the file exceeds max_bytes.
std::string read_text_file(const std::string& path, std::size_t max_bytes = std::size_t{256} << 20);

// Length in bytes of the UTF-8 character at the start of text; 0 if it is invalid (truncated, overlong,
// surrogate, beyond U+10FFFF).
std::size_t utf8_length(std::string_view text);

// The text for a terminal: "?" for control characters other than a line end and for what is not UTF-8, and cut
// after 2000 bytes.
std::string printable(std::string_view text);

// Throws ConfigError for a text that begins as UTF-16 does.
void refuse_utf16(std::string_view text, const std::string& file);

// Why a number cannot be read although it looks like one: ": it has U+2212, a minus sign of typography". Empty if it
// has only characters that a keyboard types.
std::string typography_in(std::string_view number);

// The line, from 1, of the first control character that no text file has; 0 if there is none.
int line_of_control_character(std::string_view text);

}  // namespace swiftlet::io

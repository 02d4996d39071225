#include "swiftlet/io/text_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {

namespace {

[[noreturn]] void fail(const std::string& path) {
  throw ConfigError(path, 0, "", "cannot be read: " + std::generic_category().message(errno));
}

constexpr std::size_t kLongestMessage = 2000;

}  // namespace

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  }
  const bool overlong = (lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xf0 && byte(1) < 0x90);
  const bool no_character = (lead == 0xed && byte(1) > 0x9f) || (lead == 0xf4 && byte(1) > 0x8f);
  return overlong || no_character ? 0 : length;
}

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty() && out.size() < kLongestMessage) {
    const std::size_t length = utf8_length(text);
    const bool is_second_control_set =
        length == 2 && text[0] == '\xc2' && static_cast<unsigned char>(text[1]) < 0xa0;
    const bool shown =
        length == 1 ? is_printable(text[0]) || text[0] == '\n' : length > 1 && !is_second_control_set;
    out += shown ? std::string(text.substr(0, length)) : "?";
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return text.empty() ? out : out + "...";
}

void refuse_utf16(std::string_view text, const std::string& file) {
  const std::string_view begin = text.substr(0, 2);
  if (begin == "\xff\xfe" || begin == "\xfe\xff") throw ConfigError(file, 0, "", "is UTF-16, must be UTF-8");
}

std::string typography_in(std::string_view number) {
  constexpr std::pair<const char*, const char*> kCharacters[] = {
      {"\xe2\x88\x92", "U+2212, a minus sign of typography"},
      {"\xe2\x80\x93", "U+2013, a dash"},
      {"\xc2\xa0", "U+00A0, a no-break space"},
      {"\xe2\x80\xaf", "U+202F, a no-break space"},
  };
  for (const auto& [utf8, name] : kCharacters) {
    if (number.find(utf8) != std::string_view::npos) return std::string(": it has ") + name;
  }
  return "";
}

int line_of_control_character(std::string_view text) {
  const auto is_control = [](char c) { return !is_printable(c) && c != '\n' && c != '\r' && c != '\t'; };
  const auto found = std::find_if(text.begin(), text.end(), is_control);
  return found == text.end() ? 0 : 1 + static_cast<int>(std::count(text.begin(), found, '\n'));
}

std::string read_text_file(const std::string& path, std::size_t max_bytes) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) fail(path);
  std::string text;
  std::array<char, 65536> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    text.append(buffer.data(), count);
    if (text.size() > max_bytes) {
      throw ConfigError(path, 0, "",
                        "is too large, must hold at most " + std::to_string(max_bytes) + " bytes");
    }
  }
  if (std::ferror(file.get())) fail(path);
  return text;
}

}  // namespace swiftlet::io

#include "swiftlet/io/network_key.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <sys/random.h>
#include <system_error>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/owner_only.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

constexpr std::size_t kLargestKeyFile = 4096;  // bytes

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

NetworkKey parse_key(const std::string& file, int line, const std::string& text) {
  NetworkKey key{};
  bool valid = text.size() == 2 * key.size();
  for (std::size_t i = 0; valid && i < key.size(); ++i) {
    const int high = hex_digit(text[2 * i]);
    const int low = hex_digit(text[2 * i + 1]);
    valid = high >= 0 && low >= 0;
    if (valid) key[i] = static_cast<std::uint8_t>(16 * high + low);
  }
  if (!valid) throw ConfigError(file, line, "", "is not a key, must be 64 digits of 0-9 and a-f");
  return key;
}

}  // namespace

NetworkKey random_network_key() {
  NetworkKey key{};
  if (::getrandom(key.data(), key.size(), 0) != static_cast<ssize_t>(key.size()))
    throw std::runtime_error("the system has no random numbers: " + std::generic_category().message(errno));
  return key;
}

NetworkKeys read_network_keys(const std::filesystem::path& file) {
  require_owner_only(file);
  const std::string text = read_text_file(file, kLargestKeyFile);
  NetworkKeys keys;
  int line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string words = text.substr(begin, end - begin);
    begin = end + 1;
    ++line;
    if (words.empty() || words[0] == '#') continue;
    if (keys.size() == kMostNetworkKeys)
      throw ConfigError(file, line, "", "is a third key, must be one or two");
    keys.push_back(parse_key(file, line, words));
  }
  if (keys.empty()) throw ConfigError(file, 0, "", "has no key, must have one or two");
  return keys;
}

void write_network_keys(const std::filesystem::path& file, const NetworkKeys& keys) {
  std::string text = "# Network key of Swiftlet: processes send with the first key, and accept each.\n";
  for (const NetworkKey& key : keys) {
    char digits[3];
    for (const std::uint8_t byte : key) {
      std::snprintf(digits, sizeof digits, "%02x", byte);
      text += digits;
    }
    text += "\n";
  }
  write_for_owner_only(file, text);
}

}  // namespace swiftlet::io

#include "swiftlet/io/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::runtime {

namespace {

[[noreturn]] void fail(const std::string& path) {
  throw ConfigError(path, 0, "", "cannot be read: " + std::generic_category().message(errno));
}

}  // namespace

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

}  // namespace swiftlet::runtime

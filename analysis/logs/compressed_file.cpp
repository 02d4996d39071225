#include "swiftlet/analysis/logs/compressed_file.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <zlib.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::analysis {
namespace {

constexpr std::size_t kMostBytes = std::size_t{256} << 20;

}  // namespace

std::string read_unpacked(const std::string& path) {
  std::string text = io::read_text_file(path, kMostBytes);
  if (text.compare(0, 2, "\x1f\x8b") != 0) return text;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw io::ConfigError(path, 0, "", "cannot be read");
  text.clear();
  std::array<char, 65536> buffer;
  int count = 0;
  while ((count = gzread(file.get(), buffer.data(), static_cast<unsigned>(buffer.size()))) > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > kMostBytes)
      throw io::ConfigError(path, 0, "",
                            "is too large, must hold at most " + std::to_string(kMostBytes) + " bytes");
  }
  int fault = Z_OK;
  const char* const reason = gzerror(file.get(), &fault);
  if (count < 0 || (fault != Z_OK && fault != Z_STREAM_END) || gzdirect(file.get()) != 0)
    throw io::ConfigError(path, 0, "", std::string("cannot be unpacked: ") + reason);
  return text;
}

}  // namespace swiftlet::analysis

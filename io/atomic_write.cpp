#include "swiftlet/io/atomic_write.hpp"

#include <fstream>
#include <stdexcept>
#include <system_error>

namespace swiftlet::ground {

void write_atomically(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path unfinished = file.string() + ".part";
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  std::error_code fault;
  if (out) std::filesystem::rename(unfinished, file, fault);
  if (out && !fault) return;
  std::filesystem::remove(unfinished, fault);
  throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace swiftlet::ground

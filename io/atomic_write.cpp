#include "swiftlet/io/atomic_write.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace swiftlet::ground {

void write_atomically(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path unfinished = file.string() + ".part";
  errno = 0;
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  std::error_code fault(out ? 0 : errno, std::generic_category());
  if (out) std::filesystem::rename(unfinished, file, fault);
  if (out && !fault) return;
  std::error_code ignored;
  std::filesystem::remove(unfinished, ignored);
  throw std::runtime_error(file.string() + ": cannot be written" + (fault ? ": " + fault.message() : ""));
}

}  // namespace swiftlet::ground

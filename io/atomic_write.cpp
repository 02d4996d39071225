#include "swiftlet/io/atomic_write.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace swiftlet::io {

namespace fs = std::filesystem;

fs::path unfinished_name(const fs::path& file) {
  std::error_code ignored;
  const bool is_device = fs::exists(file, ignored) && !fs::is_regular_file(file, ignored);
  return is_device ? file : fs::path(file.string() + ".part");
}

void finish_file(const fs::path& file) {
  const fs::path unfinished = unfinished_name(file);
  std::error_code fault;
  if (unfinished != file) fs::rename(unfinished, file, fault);
  if (fault) throw std::runtime_error(write_fault(file, fault.value()));
}

void write_atomically(const fs::path& file, const std::string& text) {
  const fs::path unfinished = unfinished_name(file);
  errno = 0;
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  try {
    if (!out) throw std::runtime_error(write_fault(file, errno));
    finish_file(file);
  } catch (const std::runtime_error&) {
    std::error_code ignored;
    if (unfinished != file) fs::remove(unfinished, ignored);
    throw;
  }
}

std::string write_fault(const fs::path& file, int error) {
  return file.string() + ": cannot be written" +
         (error == 0 ? "" : ": " + std::generic_category().message(error));
}

}  // namespace swiftlet::io

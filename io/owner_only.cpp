#include "swiftlet/io/owner_only.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <stdexcept>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io {
namespace {

constexpr mode_t kRightsOfOthers = S_IRWXG | S_IRWXO;

// Whether the file was made, and all of the text is on the disk. If not, errno says why.
bool write_new(const std::filesystem::path& file, const std::string& text) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) return false;
  std::size_t written = 0;
  ssize_t count = 0;
  while (written < text.size() && (count = ::write(descriptor, &text[written], text.size() - written)) > 0)
    written += static_cast<std::size_t>(count);
  const bool done = written == text.size() && ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return done;
}

}  // namespace

void require_owner_only(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0)
    throw ConfigError(file, 0, "", "cannot be read: " + std::generic_category().message(errno));
  if ((status.st_mode & kRightsOfOthers) == 0) return;
  char rights[8];
  std::snprintf(rights, sizeof rights, "%04o", status.st_mode & 07777U);
  throw ConfigError(file, 0, "",
                    std::string("has rights ") + rights + ", must be 0600: others could read the key");
}

void write_unfinished_for_owner_only(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path unfinished = unfinished_name(file);
  if (unfinished == file) throw std::runtime_error(file.string() + ": cannot be written: is not a file");
  if (::unlink(unfinished.c_str()) != 0 && errno != ENOENT)
    throw std::runtime_error(write_fault(unfinished, errno));
  if (write_new(unfinished, text)) return;
  const int error = errno;
  ::unlink(unfinished.c_str());
  throw std::runtime_error(write_fault(file, error));
}

void write_for_owner_only(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path unfinished = unfinished_name(file);
  write_unfinished_for_owner_only(file, text);
  try {
    finish_file(file);
  } catch (const std::runtime_error&) {
    ::unlink(unfinished.c_str());
    throw;
  }
}

}  // namespace swiftlet::io

// A folder for files that are needed for a while only.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace swiftlet::io {

// An empty folder for its owner only, named PREFIX.XXXXXX with six random characters. Removed with its contents at the
// end, unless keep() was called.
class TemporaryFolder {
 public:
  // Throws std::system_error that names the prefix, if the folder cannot be made.
  explicit TemporaryFolder(const std::filesystem::path& prefix) {
    std::string name = prefix.string() + ".XXXXXX";
    if (mkdtemp(name.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), prefix.string() + ": cannot be written");
    path_ = std::move(name);
  }
  // In the folder of the system for such files.
  static TemporaryFolder of_the_system(const std::string& name) {
    return TemporaryFolder(std::filesystem::temp_directory_path() / name);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void keep() { kept_ = true; }

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

}  // namespace swiftlet::io

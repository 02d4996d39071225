// $PATH during a test.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace swiftlet::tests {

// $PATH is this folder alone, as long as the object lives.
class ProgramPath {
 public:
  explicit ProgramPath(const std::filesystem::path& folder) {
    const char* const path = std::getenv("PATH");
    before_ = path != nullptr ? path : "";
    setenv("PATH", folder.c_str(), 1);
  }
  ~ProgramPath() { setenv("PATH", before_.c_str(), 1); }
  ProgramPath(const ProgramPath&) = delete;
  ProgramPath& operator=(const ProgramPath&) = delete;

 private:
  std::string before_;
};

// Writes a shell script that can be started as a program.
inline void write_program(const std::filesystem::path& file, const std::string& script) {
  std::ofstream(file) << "#!/bin/sh\n" << script << "\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

}  // namespace swiftlet::tests

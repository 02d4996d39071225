// A folder for the files of one test.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/temporary_folder.hpp"

namespace swiftlet::tests {

// Removed with its contents, unless the test failed or keep() was called: its files are kept for inspection.
class TemporaryFolder {
 public:
  ~TemporaryFolder() {
    if (testing::Test::HasFailure()) keep();
  }
  const std::filesystem::path& path() const { return folder_.path(); }
  void keep() { folder_.keep(); }

  // Writes a file into it and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name) << text;
    return path() / name;
  }

 private:
  io::TemporaryFolder folder_ = io::TemporaryFolder::of_the_system("swiftlet-test");
};

}  // namespace swiftlet::tests

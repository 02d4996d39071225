// Files that only their owner may read.
#include "swiftlet/io/owner_only.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::io::owner_only_test {

namespace fs = std::filesystem;

class OwnerOnly : public testing::Test {
 protected:
  void expect_secret() const {
    EXPECT_EQ(fs::symlink_status(file_).type(), fs::file_type::regular);
    EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(read_text_file(file_), "secret");
    EXPECT_FALSE(fs::exists(unfinished_));
  }

  const tests::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "private.key";
  const fs::path unfinished_ = folder_.path() / "private.key.part";
};

TEST_F(OwnerOnly, ReplacesFilesThatOthersMayRead) {
  folder_.write("private.key", "old");
  folder_.write("private.key.part", "left behind");
  fs::permissions(file_, fs::perms::all);
  fs::permissions(unfinished_, fs::perms::all);
  write_for_owner_only(file_, "secret");
  expect_secret();
}

TEST_F(OwnerOnly, WritesNothingToWhereALinkLeads) {
  const std::string elsewhere = folder_.write("elsewhere", "other");
  fs::create_symlink(elsewhere, unfinished_);
  write_for_owner_only(file_, "secret");
  expect_secret();
  EXPECT_EQ(read_text_file(elsewhere), "other");
}

TEST_F(OwnerOnly, KeepsTheOldFileIfItCannotWrite) {
  folder_.write("private.key", "old");
  fs::create_directory(unfinished_);
  EXPECT_THROW(write_for_owner_only(file_, "secret"), std::runtime_error);
  EXPECT_EQ(read_text_file(file_), "old");
  EXPECT_THROW(write_for_owner_only(folder_.path(), "secret"), std::runtime_error) << "a folder";
  EXPECT_TRUE(fs::is_directory(folder_.path()));
}

}  // namespace swiftlet::io::owner_only_test

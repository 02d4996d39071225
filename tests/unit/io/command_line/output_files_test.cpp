#include "swiftlet/io/command_line/output_files.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "swiftlet/io/command_line/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::io::output_files_test {

TEST(OutputFiles, MustNotOverwriteInputs) {
  const tests::TemporaryFolder folder;
  const std::string log = folder.write("log.csv", "t\n");
  const std::string by_another_name = (folder.path() / "." / "log.csv").string();
  EXPECT_NO_THROW(
      refuse_overwriting({{"--out", (folder.path() / "new.yaml").string()}, {"--report", ""}}, {log}));
  EXPECT_THROW(refuse_overwriting({{"--out", by_another_name}}, {log}), InputError);
  std::filesystem::create_symlink(log, folder.path() / "link.csv");
  EXPECT_THROW(
      refuse_overwriting({{"--out", (folder.path() / "link.csv").string()}}, files_of(folder.path())),
      InputError);
}

TEST(OutputFiles, MustBeDistinct) {
  EXPECT_THROW(refuse_overwriting({{"--out", "a"}, {"--report", "./a"}}, {}), InputError);
  EXPECT_NO_THROW(refuse_overwriting({{"--out", ""}, {"--report", ""}}, {}));
}

}  // namespace swiftlet::io::output_files_test

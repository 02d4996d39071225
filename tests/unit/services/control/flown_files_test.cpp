#include "swiftlet/services/control/flown_files.hpp"

#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/security/digest.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::services::flown_files_test {

std::string text_of(const messages::msg::SettingsFile& file) { return file.text().c_str(); }

TEST(FlownFiles, AreTheFilesAsTheyWereRead) {
  const tests::TemporaryFolder folder;
  const std::string vehicle = "name: lab25\n# \xc2\xb5\n", control(65536, 'c');
  const messages::msg::FlownFiles files =
      flown_files("swiftlet-control 1", folder.write("v.yaml", vehicle), folder.write("c.yaml", control));
  EXPECT_STREQ(files.program().c_str(), "swiftlet-control 1");
  EXPECT_EQ(text_of(files.vehicle()), vehicle);
  EXPECT_EQ(files.vehicle().sha256().c_str(), io::sha256(vehicle));
  EXPECT_EQ(text_of(files.control()), control);
}

TEST(FlownFiles, OfAFileThatIsTooLongHaveItsHashAlone) {
  const tests::TemporaryFolder folder;
  const std::string vehicle(65537, 'v');
  const messages::msg::FlownFiles files =
      flown_files("swiftlet-control 1", folder.write("v.yaml", vehicle), folder.write("c.yaml", "a: 1"));
  EXPECT_EQ(text_of(files.vehicle()), "");
  EXPECT_EQ(files.vehicle().sha256().c_str(), io::sha256(vehicle));
  EXPECT_EQ(text_of(files.control()), "a: 1");
}

}  // namespace swiftlet::services::flown_files_test

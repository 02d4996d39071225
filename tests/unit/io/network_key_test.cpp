#include "swiftlet/io/network_key.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::io::network_key_test {

namespace fs = std::filesystem;

class NetworkKeyFile : public testing::Test {
 protected:
  // Writes a file with these rights, and returns what is said of it; "" if it is valid.
  std::string fault_of(const std::string& text, fs::perms rights = fs::perms::owner_read) {
    fs::remove(file_);
    std::ofstream(file_) << text;
    fs::permissions(file_, rights);
    try {
      read_network_keys(file_);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }

  const swiftlet::tests::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "lab.key";
  const std::string key_ = std::string(62, '0') + "7f";
};

TEST_F(NetworkKeyFile, IsReadAsItWasWritten) {
  const NetworkKeys keys{random_network_key(), random_network_key()};
  EXPECT_NE(keys[0], keys[1]);
  write_network_keys(file_, keys);
  EXPECT_EQ(read_network_keys(file_), keys);
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(NetworkKeyFile, BelongsToItsOwnerAlone) {
  EXPECT_EQ(fault_of(key_), "");
  const std::string fault = fault_of(key_, fs::perms::owner_read | fs::perms::group_read);
  EXPECT_NE(fault.find("has rights 0440, must be 0600"), std::string::npos) << fault;
}

TEST_F(NetworkKeyFile, NamesTheLineOfWhatIsNoKey) {
  EXPECT_NE(fault_of("# lab\n" + key_ + "0\n").find(":2: is not a key"), std::string::npos)
      << fault_of("# lab\n" + key_ + "0\n");
  EXPECT_NE(fault_of("G" + key_.substr(1)).find(":1: is not a key"), std::string::npos);
  EXPECT_NE(fault_of(key_ + "\n" + key_ + "\n" + key_).find(":3: is a third key"), std::string::npos);
  EXPECT_NE(fault_of("# nothing\n").find("has no key"), std::string::npos);
}

TEST_F(NetworkKeyFile, ThatIsMissingIsNamed) {
  EXPECT_THROW(read_network_keys(folder_.path() / "none.key"), ConfigError);
}

}  // namespace swiftlet::io::network_key_test

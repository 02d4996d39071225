#include "swiftlet/services/dds/node_options.hpp"

#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace swiftlet::dds::node_options_test {

class NodeOptions : public testing::Test {
 protected:
  bool parses(const std::string& line) {
    runtime::Program program("test", "");
    settings_ = {};
    add_node_options(program.command_line(), settings_);
    return program.parse(line) == runtime::Program::Parsed::kRun;
  }
  NodeSettings settings_;
};

TEST_F(NodeOptions, TakeSeveralPeersAndInterfaces) {
  ASSERT_TRUE(parses("--peer lab2 --peer 10.0.0.7:7412 --interface lo"));
  EXPECT_EQ(settings_.network.peers, (std::vector<std::string>{"lab2", "10.0.0.7:7412"}));
  EXPECT_EQ(settings_.network.interfaces, std::vector<std::string>{"lo"});
  EXPECT_FALSE(settings_.network.uses_multicast());
  ASSERT_TRUE(parses("--interface 127.0.0.1"));
  EXPECT_TRUE(settings_.network.uses_multicast());
}

TEST_F(NodeOptions, RefuseWhatCannotBe) {
  EXPECT_FALSE(parses("--peer lab2:0"));
  EXPECT_FALSE(parses("--interface wlan9"));
  EXPECT_FALSE(parses("--peer lab2 --localhost-only"));
  EXPECT_FALSE(parses("--interface lo --localhost-only"));
  EXPECT_FALSE(parses("--peer lab2 lab3"));
  EXPECT_FALSE(parses("--discovery-server lab1:0"));
  EXPECT_FALSE(parses("--discovery-server lab1 --peer lab2"));
  EXPECT_FALSE(parses("--discovery-server lab1 --localhost-only"));
}

TEST_F(NodeOptions, OpenTheNetwork) {
  ASSERT_TRUE(parses(""));
  EXPECT_TRUE(settings_.on_loopback());
  ASSERT_TRUE(parses("--open-network"));
  EXPECT_FALSE(settings_.on_loopback());
  EXPECT_FALSE(parses("--open-network --localhost-only"));
  setenv("SWIFTLET_OPEN_NETWORK", "1", 1);
  ASSERT_TRUE(parses(""));
  EXPECT_FALSE(settings_.on_loopback());
  ASSERT_TRUE(parses("--localhost-only"));
  EXPECT_TRUE(settings_.on_loopback());
  unsetenv("SWIFTLET_OPEN_NETWORK");
  settings_ = {};
  settings_.network_key_file = "lab.key";
  EXPECT_FALSE(settings_.on_loopback());
  settings_.localhost_only = true;
  EXPECT_TRUE(settings_.on_loopback());
}

TEST_F(NodeOptions, WinOverTheNetworkFile) {
  const tests::TemporaryFolder folder;
  const std::string peers = "--network " + folder.write("peers.yaml", "peers: [lab2]\n");
  ASSERT_TRUE(parses(peers));
  EXPECT_EQ(settings_.network.peers, std::vector<std::string>{"lab2"});
  ASSERT_TRUE(parses("--peer lab3 " + peers));
  EXPECT_EQ(settings_.network.peers, std::vector<std::string>{"lab3"});
  ASSERT_TRUE(parses("--localhost-only " + peers));
  EXPECT_TRUE(settings_.network.peers.empty());
  ASSERT_TRUE(parses("--discovery-server lab1 " + peers));
  EXPECT_TRUE(settings_.network.peers.empty());
  EXPECT_FALSE(parses("--network " + folder.write("wrong.yaml", "peers: [lab2:0]\n")));
  EXPECT_FALSE(parses("--network " + (folder.path() / "missing.yaml").string()));
}

TEST_F(NodeOptions, WinOverTheEnvironment) {
  setenv("ROS_DISCOVERY_SERVER", "lab1:11811;lab2:11811", 1);
  EXPECT_TRUE(parses(""));
  EXPECT_EQ(settings_.network.discovery_servers, "lab1:11811;lab2:11811");
  EXPECT_TRUE(parses("--discovery-server lab3"));
  EXPECT_EQ(settings_.network.discovery_servers, "lab3");
  EXPECT_TRUE(parses("--peer lab3"));
  EXPECT_EQ(settings_.network.discovery_servers, "");
  EXPECT_TRUE(parses("--localhost-only"));
  EXPECT_EQ(settings_.network.discovery_servers, "");
  unsetenv("ROS_DISCOVERY_SERVER");
}

TEST_F(NodeOptions, TakeThePeersOfRos) {
  setenv("ROS_STATIC_PEERS", "lab1;10.0.0.7;", 1);
  EXPECT_TRUE(parses(""));
  EXPECT_EQ(settings_.network.peers, (std::vector<std::string>{"lab1", "10.0.0.7"}));
  EXPECT_TRUE(parses("--peer lab3"));
  EXPECT_EQ(settings_.network.peers, std::vector<std::string>{"lab3"});
  for (const char* line : {"--discovery-server lab3", "--localhost-only"}) {
    EXPECT_TRUE(parses(line));
    EXPECT_TRUE(settings_.network.peers.empty()) << line;
  }
  unsetenv("ROS_STATIC_PEERS");
}

TEST_F(NodeOptions, TakeTheProfileOfEitherFastDds) {
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", "of_2.xml", 1);
  EXPECT_TRUE(parses(""));
  EXPECT_EQ(settings_.network.dds_profile, "of_2.xml");
  setenv("FASTDDS_DEFAULT_PROFILES_FILE", "of_3.xml", 1);
  EXPECT_TRUE(parses(""));
  EXPECT_EQ(settings_.network.dds_profile, "of_3.xml");
  EXPECT_TRUE(parses("--dds-profile mine.xml"));
  EXPECT_EQ(settings_.network.dds_profile, "mine.xml");
  unsetenv("FASTDDS_DEFAULT_PROFILES_FILE");
  unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");
}

}  // namespace swiftlet::dds::node_options_test

#include "swiftlet/services/dds/node_options.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::comms {
namespace {

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
}

}  // namespace
}  // namespace swiftlet::comms

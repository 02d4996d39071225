#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/io/network_key.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::dds::network_file_test {

NodeSettings applied(const std::string& text, NodeSettings settings = {}) {
  apply_network_file(text, "/etc/swiftlet/network.yaml", settings);
  return settings;
}

std::string refusal(const std::string& text) {
  try {
    applied(text);
    return "accepted";
  } catch (const io::ConfigError& error) {
    return error.what();
  }
}

TEST(NetworkFile, SetsWhatItHas) {
  const NodeSettings peers =
      applied("peers: [lab2, 10.0.0.7:7412]\ninterfaces: [lo]\ndds_profile: profile.xml\n");
  EXPECT_EQ(peers.network.peers, (std::vector<std::string>{"lab2", "10.0.0.7:7412"}));
  EXPECT_EQ(peers.network.interfaces, std::vector<std::string>{"lo"});
  EXPECT_EQ(peers.network.dds_profile, "/etc/swiftlet/profile.xml");
  EXPECT_EQ(applied("discovery_servers: [lab1, lab2:11812]\n").network.discovery_servers, "lab1;lab2:11812");
  EXPECT_TRUE(applied("open_network: false\n").on_loopback());
  EXPECT_FALSE(applied("open_network: true\n").on_loopback());
  EXPECT_EQ(applied("interfaces: [lo]\n", peers).network.peers, peers.network.peers);
}

TEST(NetworkFile, NamesAValidNetworkKey) {
  const swiftlet::tests::TemporaryFolder folder;
  io::write_network_keys(folder.path() / "lab.key", {io::random_network_key()});
  NodeSettings settings;
  apply_network_file("network_key: lab.key\n", folder.path() / "network.yaml", settings);
  EXPECT_EQ(settings.network_key_file, folder.path() / "lab.key");
  EXPECT_EQ(refusal("network_key: none.key\n"),
            "/etc/swiftlet/none.key: cannot be read: No such file or directory");
}

TEST(NetworkFile, ReplacesAnotherWayOfDiscovery) {
  const NodeSettings server = applied("discovery_servers: [lab1]\n", applied("peers: [lab2]\n"));
  EXPECT_TRUE(server.network.peers.empty());
  EXPECT_TRUE(applied("peers: [lab2]\n", server).network.discovery_servers.empty());
}

TEST(NetworkFile, NamesWhatIsWrong) {
  const std::string file = "/etc/swiftlet/network.yaml:";
  const std::string address =
      ", must be HOST or HOST:PORT, a name or IPv4 address and a port from 1 to 65535";
  EXPECT_EQ(refusal("peers:\n  - lab2\n  - lab3:0\n"), file + "3: peers[1]: is 'lab3:0'" + address);
  EXPECT_EQ(refusal("discovery_servers: [':1']\n"), file + "1: discovery_servers[0]: is ':1'" + address);
  EXPECT_EQ(refusal("open_network: true\ninterfaces: [wlan9]\n"),
            file +
                "2: interfaces[0]: is 'wlan9', must be an interface that is up, by name or IPv4 address: " +
                io::interfaces_text(false));
  EXPECT_EQ(refusal("peers: [lab2]\ndiscovery_servers: [lab1]\n"),
            file + "2: discovery_servers: excludes peers");
  for (const std::string key : {"peer", "transport", "localhost_only"}) {
    const std::string unknown = refusal("interfaces: [lo]\n" + key + ": udp\n");
    EXPECT_EQ(unknown.find(file + "2: " + key + ": is unknown, must be one of "), 0U) << unknown;
  }
  EXPECT_NE(refusal("peers: []\n"), "accepted");
  EXPECT_NE(refusal("open_network: yes please\n"), "accepted");
}

}  // namespace swiftlet::dds::network_file_test

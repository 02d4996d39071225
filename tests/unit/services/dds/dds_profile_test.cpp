#include <climits>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

#include <fastdds/dds/log/Log.hpp>
#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/log_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::dds::dds_profile_test {

// Fast DDS keeps the profiles of all files that it has read.
std::string unique_name() {
  static int count = 0;
  return "lab" + std::to_string(++count);
}

std::string with(const std::string& in_profiles, const std::string& in_rtps) {
  return "<?xml version=\"1.0\"?>\n<dds>\n<profiles>\n" + in_profiles + "<participant profile_name=\"" +
         unique_name() + "\">\n<rtps>\n" + in_rtps + "</rtps>\n</participant>\n</profiles>\n</dds>\n";
}

std::string descriptor(const std::string& id, const std::string& more) {
  return "<transport_descriptors><transport_descriptor>\n<transport_id>" + id + "</transport_id>\n" + more +
         "</transport_descriptor></transport_descriptors>\n";
}

std::string user_transport(const std::string& id) {
  return "<userTransports><transport_id>" + id + "</transport_id></userTransports>\n";
}

class DdsProfiles : public testing::Test {
 protected:
  NodeSettings settings_with(const std::string& file) const {
    NodeSettings settings;
    settings.name = "here";
    settings.domain = lock_.domain();
    settings.network.dds_profile = file;
    return settings;
  }
  std::string refusal(const std::string& text) const {
    const std::string name = unique_name() + ".xml";  // Fast DDS reads a file once
    try {
      const Node node(settings_with(folder_.write(name, text)));
      return "accepted";
    } catch (const io::ConfigError& error) {
      const std::string prefix = (folder_.path() / name).string() + ":";
      const std::string what = error.what();
      return what.rfind(prefix, 0) == 0 ? what.substr(prefix.size()) : what;
    }
  }

  const DomainLock lock_;
  const tests::TemporaryFolder folder_;
};

// The receive buffers of the sockets of this process.
int sockets_with_buffer(int bytes) {
  int count = 0;
  for (int descriptor = 0; descriptor < 1024; ++descriptor) {
    int size = 0;
    socklen_t length = sizeof size;
    if (::getsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &size, &length) == 0 && size == bytes) ++count;
  }
  return count;
}

TEST_F(DdsProfiles, AreApplied) {
  constexpr int kBytes = 77000;
  const std::string file = folder_.write(
      "buffers.xml", with(descriptor("mine", "<type>UDPv4</type>\n<receiveBufferSize>" +
                                                 std::to_string(kBytes) + "</receiveBufferSize>\n"),
                          user_transport("mine")));
  {
    const Node plain(settings_with(""));
    EXPECT_EQ(sockets_with_buffer(2 * kBytes), 0);  // the kernel doubles it
  }
  {
    const Node node(settings_with(file));
    EXPECT_GE(sockets_with_buffer(2 * kBytes), 2);
  }
  const std::string of_participant =
      folder_.write("sizes.xml", with("", "<listenSocketBufferSize>78000</listenSocketBufferSize>\n"));
  const Node node(settings_with(of_participant));
  EXPECT_GE(sockets_with_buffer(2 * 78000), 2);
}

TEST_F(DdsProfiles, AreRefusedIfBroken) {
  EXPECT_EQ(refusal("<dds>\n<profiles>\n</dds>\n").rfind("2: is no valid XML: ", 0), 0U)
      << refusal("<dds>\n<profiles>\n</dds>\n");
  const std::string none = " must be <dds> with <profiles> and in it a <participant profile_name=...>";
  EXPECT_EQ(refusal("<!-- nothing -->\n"), none);
  EXPECT_EQ(refusal("<html/>\n"), none);
  EXPECT_EQ(refusal("<dds><profiles></profiles></dds>\n"), none);
  EXPECT_EQ(refusal(with(descriptor("t", "<type>TCPv4</type>\n"), user_transport("t"))),
            " <userTransports>: must name a transport of type UDPv4");
  testing::internal::CaptureStderr();
  EXPECT_EQ(refusal(with("", "<sendSocketBufferSize>much</sendSocketBufferSize>\n")),
            " is refused by Fast DDS: see its error above");
  eprosima::fastdds::dds::Log::Flush();
  const std::string errors = testing::internal::GetCapturedStderr();
  EXPECT_NE(errors.find("sendSocketBufferSize"), std::string::npos) << errors;
  EXPECT_THROW(Node(settings_with("/no/such/profile.xml")), io::ConfigError);
}

// What Swiftlet sets itself is set over the profile.
TEST_F(DdsProfiles, DoNotChangeWhatSwiftletSets) {
  const std::string file =
      folder_.write("more.xml", with("<data_writer profile_name=\"w\"/>\n",
                                     "<name>other</name>\n"
                                     "<useBuiltinTransports>true</useBuiltinTransports>\n"
                                     "<builtin><discovery_config><discoveryProtocol>NONE</"
                                     "discoveryProtocol></discovery_config></builtin>\n"));
  const Node here(settings_with(file));
  NodeSettings there_settings = settings_with("");
  there_settings.name = "there";
  tests::Inbox<std::string> peers;
  Node there(there_settings);
  there.on_peer([&](const PeerEvent& event) { peers.put(event.name); });
  ASSERT_TRUE(peers.wait_for_count(1));
  EXPECT_EQ(peers.items().front(), "here");
}

// Fast DDS refuses an announcement that is longer than the profile allows; the others then never hear of the second vehicle.
TEST_F(DdsProfiles, SayWhatTheyKeepFromBeingAnnounced) {
  char host[HOST_NAME_MAX + 1] = {};
  ::gethostname(host, HOST_NAME_MAX);
  const std::string announced =
      "enclave=/;vehicle=kl1;host=" + std::string(host) + ";process=" + std::to_string(::getpid()) + ";";
  const std::string limit = std::to_string(announced.size() + 2);
  const Participant participant(
      settings_with(folder_.write(
          "small.xml", with("", "<allocation><max_user_data>" + limit + "</max_user_data></allocation>\n"))),
      {"kl1"});
  const Node first(participant, "kl1");
  const tests::LogText log;
  const Node second(participant, "kl2");
  const std::string sentence = "the middleware refuses to announce a change of this process to the others";
  EXPECT_TRUE(tests::eventually([&] { return log.lines().find(sentence) != std::string::npos; }))
      << log.lines();
}

}  // namespace swiftlet::dds::dds_profile_test

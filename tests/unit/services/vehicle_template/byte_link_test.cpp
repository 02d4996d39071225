#include "swiftlet/services/vehicle_template/byte_link.hpp"

#include <cerrno>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/services/microcontroller/port.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::services::byte_link_test {

std::string refusal(const ByteLinkSettings& settings) {
  try {
    const ByteLink link(settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ByteLink, RefusesLinksThatCannotBe) {
  EXPECT_EQ(refusal({}), "the link: give either --device or --udp");
  EXPECT_EQ(refusal({"/dev/x", 921'600, "127.0.0.1:9000"}), "the link: give either --device or --udp");
  EXPECT_EQ(refusal({"/dev/x", 12'345, ""}).rfind("--baud: is 12345, must be one of 57600, 115200, ", 0), 0U);
  EXPECT_EQ(refusal({"", 921'600, "127.0.0.1"}), "--udp: is '127.0.0.1', must be HOST:PORT, with a port");
  EXPECT_NE(refusal({"", 921'600, "a:b"}), "");
}

TEST(ByteLink, CarriesAllBytesOverATerminalBothWays) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.path() / "tty";
  const std::unique_ptr<Port> far_end = open_pseudo_terminal(path);
  ByteLink link({path, 115'200, ""});
  ASSERT_EQ(link.open(), 0);
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(all.data());
  std::uint8_t received[512] = {};

  ASSERT_TRUE(link.write(bytes, all.size()));
  std::string there;
  EXPECT_TRUE(tests::eventually([&] {
    there.append(reinterpret_cast<const char*>(received), far_end->read(received, sizeof received));
    return there.size() >= all.size();
  }));
  EXPECT_EQ(there, all);

  far_end->write(bytes, all.size());
  std::string back;
  EXPECT_TRUE(tests::eventually([&] {
    back.append(reinterpret_cast<const char*>(received), link.read(received, sizeof received));
    return back.size() >= all.size();
  }));
  EXPECT_EQ(back, all);
}

TEST(ByteLink, ClosesWhenTheDeviceVanishesAndOpensWhenItIsBack) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.path() / "tty";
  ByteLink link({path, 921'600, ""});
  EXPECT_EQ(link.open(), ENOENT);
  auto far_end = open_pseudo_terminal(path);
  ASSERT_EQ(link.open(), 0);
  std::uint8_t byte = 0;
  EXPECT_EQ(link.read(&byte, 1), 0U);
  EXPECT_TRUE(link.is_open()) << "no bytes yet";

  far_end.reset();
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(path)));
  EXPECT_TRUE(tests::eventually([&] {
    link.read(&byte, 1);
    return !link.is_open();
  }));
  EXPECT_FALSE(link.write(&byte, 1));
  far_end = open_pseudo_terminal(path);
  EXPECT_EQ(link.open(), 0);
}

// GIVEN a link that has a device, WHEN another one asks for it, THEN it gets it as soon as the first has closed it, not before,
// although the far end keeps the device open.
TEST(ByteLink, HasADeviceAlone) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.path() / "tty";
  const auto far_end = open_pseudo_terminal(path);
  ByteLink first({path, 921'600, ""});
  ByteLink second({path, 921'600, ""});
  ASSERT_EQ(first.open(), 0);
  EXPECT_EQ(second.open(), EBUSY);
  EXPECT_FALSE(second.is_open());
  first.close();
  EXPECT_EQ(second.open(), 0);
}

TEST(PseudoTerminal, ReplacesALinkButNoFile) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.path() / "tty";
  std::filesystem::create_symlink("/dev/null", path);
  { const auto port = open_pseudo_terminal(path); }
  const std::string file = folder.write("file", "mine");
  EXPECT_THROW(open_pseudo_terminal(file), std::invalid_argument);
  EXPECT_EQ(std::filesystem::file_size(file), 4U);
}

TEST(UdpPort, SendsToWhoeverSentTheLastValidFrame) {
  // The address belongs to this process alone: all of 127.0.0.0/8 is this host.
  const int process = ::getpid();
  const std::string address =
      "127.1." + std::to_string(process / 256 % 256) + "." + std::to_string(process % 256) + ":29471";
  ByteLink host({"", 0, address});
  ByteLink stranger({"", 0, address});
  const auto port = open_udp_port(address);
  ASSERT_EQ(host.open() + stranger.open(), 0);
  std::uint8_t bytes[8] = {7};
  const auto receive = [&](ByteLink& from) {
    ASSERT_TRUE(from.write(bytes, 1));
    ASSERT_TRUE(tests::eventually([&] { return port->read(bytes, sizeof bytes) == 1; }));
  };
  receive(host);
  receive(stranger);
  port->refuse_sender();
  port->write(bytes, 3);
  EXPECT_TRUE(tests::eventually([&] { return host.read(bytes, sizeof bytes) == 3; }));
  EXPECT_EQ(stranger.read(bytes, sizeof bytes), 0U);
}

}  // namespace swiftlet::services::byte_link_test

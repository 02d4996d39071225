#include "swiftlet/io/mocap/capture_file.hpp"

#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::mocap::capture_file_test {

using tests::refusal;

const std::string kFile = tests::in_source("tests/data/natnet_3.0_traffic.pcapng");

// Little-endian numbers.
std::string le(std::uint64_t number, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(number >> (8 * i)));
  return out;
}

// An IPv4 packet with the UDP payload "hi".
std::string packet() {
  std::string ip = {0x45, 0, 0, 30, 0, 0, 0, 0, 64, 17, 0, 0, 10, 0, 0, 1, 10, 0, 0, 2};
  return ip + std::string({0x05, '\xe7', 0x04, '\xd2', 0, 10, 0, 0, 'h', 'i'});
}

std::string pcap(std::uint32_t magic, std::uint32_t link_type, const std::string& packet) {
  const std::string head = le(magic, 4) + le(2, 2) + le(4, 2) + le(0, 8) + le(65535, 4) + le(link_type, 4);
  return head + le(10, 4) + le(5, 4) + le(packet.size(), 4) + le(packet.size(), 4) + packet;
}

TEST(Capture, OfMotiveIsRead) {
  const auto datagrams = parse_capture(io::read_text_file(kFile), kFile);
  EXPECT_EQ(datagrams.size(), 550U);
  EXPECT_EQ(datagrams.front().source, 0xc0a80064U);  // 192.168.0.100
  EXPECT_EQ(datagrams.front().destination_port, 1510);
  EXPECT_EQ(datagrams.front().payload.size(), 268U);
  for (std::size_t i = 1; i < datagrams.size(); ++i)
    EXPECT_GE(datagrams[i].time_ns, datagrams[i - 1].time_ns);
  const double seconds = 1e-9 * static_cast<double>(datagrams.back().time_ns - datagrams.front().time_ns);
  EXPECT_GT(seconds, 4.0);
  EXPECT_LT(seconds, 60.0);
}

TEST(Capture, OfTcpdumpIsRead) {
  const std::string ethernet = std::string(12, 0) + std::string({0x08, 0x00}) + packet();
  const std::string cooked = std::string(14, 0) + std::string({0x08, 0x00}) + packet();
  const struct {
    std::uint32_t magic, link_type;
    std::string packet;
    std::int64_t time_ns;
  } kinds[] = {{0xa1b2c3d4, 1, ethernet, 10'000'005'000},
               {0xa1b23c4d, 1, ethernet, 10'000'000'005},
               {0xa1b2c3d4, 101, packet(), 10'000'005'000},
               {0xa1b2c3d4, 113, cooked, 10'000'005'000}};
  for (const auto& kind : kinds) {
    const auto datagrams = parse_capture(pcap(kind.magic, kind.link_type, kind.packet), "c");
    ASSERT_EQ(datagrams.size(), 1U) << kind.link_type;
    EXPECT_EQ(datagrams[0].time_ns, kind.time_ns);
    EXPECT_EQ(datagrams[0].source, 0x0a000001U);
    EXPECT_EQ(datagrams[0].source_port, 1511);
    EXPECT_EQ(datagrams[0].destination_port, 1234);
    EXPECT_EQ(datagrams[0].payload, (std::vector<std::uint8_t>{'h', 'i'}));
  }
}

TEST(Capture, LeavesOutWhatIsNoWholeDatagram) {
  std::string fragment = packet();
  fragment[6] = 0x20;
  std::string tcp = packet();
  tcp[9] = 6;
  const std::string cut = packet().substr(0, 29);
  for (const std::string& other : {fragment, tcp, cut})
    EXPECT_TRUE(parse_capture(pcap(0xa1b2c3d4, 101, other), "c").empty());
}

TEST(Capture, ThatIsNoneOrCutIsRefused) {
  const auto fault = [](const std::string& text) { return refusal([&] { parse_capture(text, "c"); }); };
  EXPECT_EQ(fault("t,x,y"), "c: is no capture: it begins neither like pcap nor like pcapng");
  const std::string whole = pcap(0xa1b2c3d4, 101, packet());
  EXPECT_EQ(fault(whole.substr(0, whole.size() - 1)), "c: ends within a packet");
  EXPECT_EQ(fault(whole.substr(0, 20)), "c: ends within its header");
  const std::string text = io::read_text_file(kFile);
  EXPECT_EQ(fault(text.substr(0, text.size() - 1)), "c: ends within a block");
}

}  // namespace swiftlet::mocap::capture_file_test

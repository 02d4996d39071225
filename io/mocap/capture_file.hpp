// Recorded network traffic: files of pcap and pcapng, as tcpdump and Wireshark write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace swiftlet::mocap {

struct CapturedDatagram {
  std::int64_t time_ns = 0;  // of the capture, since 1970
  std::uint32_t source = 0;  // IPv4 address, as a number
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::vector<std::uint8_t> payload;
};

// The UDP datagrams over IPv4, in the order of the file. Other packets, cut ones and fragments are left out. Throws
// ConfigError if the text is no such file or ends within a packet; file_name appears in messages only.
std::vector<CapturedDatagram> parse_capture(std::string_view text, const std::string& file_name);

}  // namespace swiftlet::mocap

// pcapng: draft-ietf-opsawg-pcapng. pcap: draft-ietf-opsawg-pcap. Link types: www.tcpdump.org/linktypes.html.
#include "swiftlet/io/mocap/capture_file.hpp"

#include <cstddef>
#include <optional>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::mocap {
namespace {

using io::ByteReader;
using io::ConfigError;

constexpr std::uint32_t kPcapMicroseconds = 0xa1b2c3d4;
constexpr std::uint32_t kPcapNanoseconds = 0xa1b23c4d;
constexpr std::uint32_t kSectionBlock = 0x0a0d0d0a;
constexpr std::uint32_t kByteOrder = 0x1a2b3c4d;
constexpr std::uint32_t kInterfaceBlock = 1;
constexpr std::uint32_t kPacketBlock = 6;
constexpr std::size_t kBlockFrame = 12;  // type, and length at both ends
constexpr std::uint16_t kEndOfOptions = 0;
constexpr std::uint16_t kResolutionOption = 9;

constexpr std::uint16_t kIpv4 = 0x0800;
constexpr std::uint16_t kVlan = 0x8100;
constexpr std::uint8_t kUdp = 17;
constexpr std::size_t kUdpHeader = 8;

enum LinkType : std::uint32_t { kNull = 0, kEthernet = 1, kRaw = 101, kLinuxCooked = 113, kIpv4Raw = 228 };

// Leaves the reader at the IPv4 header; false: the packet is none of IPv4.
bool skip_link_header(ByteReader& in, std::uint32_t link_type) {
  switch (link_type) {
    case kRaw:
    case kIpv4Raw:
      return true;
    case kNull:
      in.skip(4);
      return true;  // the version of IP is checked
    case kLinuxCooked:
      in.skip(14);
      return in.u16() == kIpv4;
    case kEthernet: {
      in.skip(12);
      std::uint16_t kind = in.u16();
      if (kind == kVlan) {
        in.skip(2);
        kind = in.u16();
      }
      return kind == kIpv4;
    }
    default:
      return false;
  }
}

std::optional<CapturedDatagram> datagram_of(ByteReader in, std::uint32_t link_type, std::int64_t time_ns) {
  if (!skip_link_header(in, link_type)) return std::nullopt;
  const std::uint8_t version = in.u8();
  const std::size_t header = 4U * (version & 0x0fU);
  in.skip(5);
  const std::uint16_t fragment = in.u16();
  in.skip(1);
  const std::uint8_t protocol = in.u8();
  in.skip(2);
  CapturedDatagram datagram;
  datagram.time_ns = time_ns;
  datagram.source = in.u32();
  in.skip(4);
  if (!in.ok() || version >> 4U != 4 || header < 20 || protocol != kUdp || (fragment & 0x3fffU) != 0)
    return std::nullopt;
  in.skip(header - 20);
  datagram.source_port = in.u16();
  datagram.destination_port = in.u16();
  const std::size_t length = in.u16();
  in.skip(2);
  if (!in.ok() || length < kUdpHeader) return std::nullopt;
  const std::uint8_t* const payload = in.take(length - kUdpHeader);
  if (payload == nullptr) return std::nullopt;
  datagram.payload.assign(payload, payload + (length - kUdpHeader));
  return datagram;
}

// Headers of the network are big-endian.
void add(std::vector<CapturedDatagram>& datagrams, const ByteReader& packet, std::uint32_t link_type,
         std::int64_t time_ns) {
  auto datagram = datagram_of(ByteReader(packet.data(), packet.rest(), false), link_type, time_ns);
  if (datagram) datagrams.push_back(std::move(*datagram));
}

std::vector<CapturedDatagram> parse_pcap(ByteReader in, const std::string& file, std::int64_t tick_ns) {
  std::vector<CapturedDatagram> datagrams;
  in.skip(20);
  const std::uint32_t link_type = in.u32() & 0xffffU;
  if (!in.ok()) throw ConfigError(file, 0, "", "ends within its header");
  while (in.rest() > 0) {
    const std::int64_t seconds = in.u32();
    const std::int64_t ticks = in.u32();
    const std::size_t bytes = in.u32();
    in.skip(4);
    const ByteReader packet = in.part(bytes);
    if (!in.ok()) throw ConfigError(file, 0, "", "ends within a packet");
    add(datagrams, packet, link_type, seconds * math::kSecond_ns + ticks * tick_ns);
  }
  return datagrams;
}

// A network interface of a pcapng file.
struct CaptureInterface {
  std::uint32_t link_type = kEthernet;
  std::uint64_t ticks_per_s = 1'000'000;
};

// The resolution option: a power of ten or, with the highest bit, of two.
std::uint64_t ticks_per_s(std::uint8_t option) {
  const unsigned exponent = option & 0x7fU;
  if ((option & 0x80U) != 0) return exponent <= 30 ? std::uint64_t{1} << exponent : 0;
  std::uint64_t ticks = 1;
  for (unsigned i = 0; i < exponent && exponent <= 9; ++i) ticks *= 10;
  return exponent <= 9 ? ticks : 0;
}

CaptureInterface read_interface(ByteReader block, const std::string& file) {
  CaptureInterface interface;
  interface.link_type = block.u16();
  block.skip(6);
  while (block.rest() >= 4) {
    const std::uint16_t option = block.u16();
    const std::size_t bytes = block.u16();
    if (option == kEndOfOptions) break;
    ByteReader value = block.part(bytes);
    block.skip((4 - bytes % 4) % 4);
    if (option == kResolutionOption) interface.ticks_per_s = ticks_per_s(value.u8());
  }
  if (!block.ok()) throw ConfigError(file, 0, "", "ends within the description of an interface");
  if (interface.ticks_per_s == 0)
    throw ConfigError(file, 0, "", "has stamps finer than 1 ns, which are not supported");
  return interface;
}

std::int64_t stamp_ns(std::uint64_t ticks, std::uint64_t ticks_per_second) {
  const std::uint64_t seconds = ticks / ticks_per_second;
  if (seconds > 9'000'000'000) return 0;
  const std::uint64_t rest = ticks % ticks_per_second;  // below 2^30
  return static_cast<std::int64_t>(seconds * 1'000'000'000 + rest * 1'000'000'000 / ticks_per_second);
}

void read_packet(ByteReader block, const std::vector<CaptureInterface>& interfaces, const std::string& file,
                 std::vector<CapturedDatagram>& datagrams) {
  const std::size_t interface = block.u32();
  const std::uint64_t high = block.u32();
  const std::uint64_t ticks = high << 32U | block.u32();
  const std::size_t bytes = block.u32();
  block.skip(4);
  const ByteReader packet = block.part(bytes);
  if (!block.ok()) throw ConfigError(file, 0, "", "ends within a packet");
  if (interface >= interfaces.size())
    throw ConfigError(file, 0, "", "has a packet of an interface that it does not describe");
  add(datagrams, packet, interfaces[interface].link_type, stamp_ns(ticks, interfaces[interface].ticks_per_s));
}

std::vector<CapturedDatagram> parse_pcapng(ByteReader in, const std::string& file) {
  std::vector<CapturedDatagram> datagrams;
  std::vector<CaptureInterface> interfaces;
  while (in.rest() > 0) {
    const std::uint32_t type = in.u32();
    const std::size_t length = in.u32();
    if (!in.ok() || length < kBlockFrame || length % 4 != 0 || length - 8 > in.rest())
      throw ConfigError(file, 0, "", "ends within a block");
    ByteReader block = in.part(length - kBlockFrame);
    in.skip(4);
    if (type == kSectionBlock) {
      if (block.u32() != kByteOrder)
        throw ConfigError(file, 0, "", "has sections of different byte order, which are not supported");
      interfaces.clear();
    }
    if (type == kInterfaceBlock) interfaces.push_back(read_interface(block, file));
    if (type == kPacketBlock) read_packet(block, interfaces, file, datagrams);
  }
  return datagrams;
}

}  // namespace

std::vector<CapturedDatagram> parse_capture(std::string_view text, const std::string& file_name) {
  const auto* const data = reinterpret_cast<const std::uint8_t*>(text.data());
  for (const bool little_endian : {true, false}) {
    ByteReader head(data, text.size(), little_endian);
    const std::uint32_t magic = head.u32();
    head.skip(4);
    const std::uint32_t order = head.u32();
    const ByteReader all(data, text.size(), little_endian);
    if (magic == kPcapMicroseconds) return parse_pcap(all, file_name, 1000);
    if (magic == kPcapNanoseconds) return parse_pcap(all, file_name, 1);
    if (magic == kSectionBlock && order == kByteOrder) return parse_pcapng(all, file_name);
  }
  throw ConfigError(file_name, 0, "", "is no capture: it begins neither like pcap nor like pcapng");
}

}  // namespace swiftlet::mocap

// The frame of an RTPS message: its header and the headers of its submessages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::rtps {

constexpr std::size_t kHeaderBytes = 20;  // of a message (9.4.4)

// Kinds of submessages (9.4.5.1.1).
enum SubmessageKind : std::uint8_t {
  kPad = 0x01,
  kAcknack = 0x06,
  kHeartbeat = 0x07,
  kGap = 0x08,
  kInfoTimestamp = 0x09,
  kInfoSource = 0x0c,
  kInfoDestination = 0x0e,
  kNackFrag = 0x12,
  kHeartbeatFrag = 0x13,
  kData = 0x15,
  kDataFrag = 0x16,
  // DDS Security, 7.3.6.2:
  kSecureBody = 0x30,
  kSecurePrefix = 0x31,
  kSecurePostfix = 0x32,
  kSecureRtpsPrefix = 0x33,
  kSecureRtpsPostfix = 0x34,
  kStatistics = 0x80,  // of Fast DDS built with statistics, which appends it to every message
  kSeal = 0x81,        // of a network key (datagram_seal.hpp)
};

constexpr std::uint8_t kLittleEndianFlag = 1;  // of every submessage (9.4.5.1.2)
constexpr std::size_t kSubmessageHeaderBytes = 4;
constexpr std::size_t kBytesBeforeIds = 4;  // of DATA: flags, and the distance to its inline QoS

// The next identifier of an endpoint; zeros behind the end.
inline EntityId entity_id(io::ByteReader& in) {
  EntityId entity{};
  if (const std::uint8_t* const bytes = in.take(entity.size()))
    std::copy_n(bytes, entity.size(), entity.begin());
  return entity;
}

// Calls found(kind, body) for each submessage up to the first that reaches to the end of the message; body is a
// io::ByteReader in its byte order. A length of 0 means to the end, but for those that may be empty (9.4.5.1.3). Returns
// whether the message ends with its last submessage.
template <class Found>
bool for_each_submessage(const std::uint8_t* message, std::size_t size, const Found& found) {
  io::ByteReader rest(message, size, true);
  rest.skip(kHeaderBytes);
  while (rest.rest() >= kSubmessageHeaderBytes) {
    const std::uint8_t kind = rest.u8();
    const bool little_endian = (rest.u8() & kLittleEndianFlag) != 0;
    const std::uint8_t* const length_at = rest.take(2);
    std::size_t length = io::ByteReader(length_at, 2, little_endian).u16();
    if (length == 0 && kind != kPad && kind != kInfoTimestamp) length = rest.rest();
    found(kind, io::ByteReader(rest.data(), std::min(length, rest.rest()), little_endian));
    rest.skip(length);
  }
  return rest.ok() && rest.rest() == 0;
}

}  // namespace swiftlet::rtps

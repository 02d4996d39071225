// The frame of an RTPS message: its header and the headers of its submessages.
#pragma once

#include <cstddef>
#include <cstdint>

namespace swiftlet::comms {

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
  // Of DDS Security (7.3.6.2):
  kSecureBody = 0x30,
  kSecurePrefix = 0x31,
  kSecurePostfix = 0x32,
  kSecureRtpsPrefix = 0x33,
  kSecureRtpsPostfix = 0x34,
  kStatistics = 0x80,  // of Fast DDS built with statistics, which appends it to every message
};

constexpr std::uint8_t kLittleEndianFlag = 1;  // of every submessage (9.4.5.1.2)

}  // namespace swiftlet::comms

// Identifiers of RTPS as bytes on the wire: participants, their endpoints, and the built-in topics of discovery.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace swiftlet::rtps {

using GuidPrefix = std::array<std::uint8_t, 12>;  // of a participant
using EntityId = std::array<std::uint8_t, 4>;     // of one of its endpoints

// By the prefixes that ROS 2 gives to discovery servers: 44.53.N.5f.45.50.52.4f.53.49.4d.41.
bool is_discovery_server(const GuidPrefix& participant);

// FNV-1a of bytes, which continues a digest of others.
inline std::uint64_t fnv(const std::uint8_t* bytes, std::size_t size,
                         std::uint64_t digest = 0xcbf29ce484222325U) {
  for (std::size_t i = 0; i < size; ++i) digest = (digest ^ bytes[i]) * 0x100000001b3U;
  return digest;
}

constexpr EntityId kUnknownEntity{};
constexpr EntityId kParticipantWriter{0x00, 0x01, 0x00, 0xc2};  // of announcements of participants
constexpr EntityId kParticipantEntity{0x00, 0x00, 0x01, 0xc1};

// What a DATA submessage is about (9.3.1.3, 9.6.3).
enum class BuiltinTopic {
  kUser,         // a topic of the application
  kParticipant,  // SPDP: a participant announces itself
  kEndpoint,     // SEDP: a participant announces a writer or reader
  kLiveliness,   // a participant asserts that it is alive
  kHandshake,    // DDS Security: participants authenticate each other
  kSecurity,     // DDS Security: keys, and the encrypted forms of the topics above
};

// By the kind in the last byte (9.3.1.2). The readers of Fast DDS accept samples of a writer without a kind from anyone.
bool is_writer(const EntityId& entity);

// An endpoint of the middleware itself (9.3.1.2).
inline bool is_builtin(const EntityId& entity) { return (entity[3] & 0xc0U) == 0xc0U; }

// nullopt: no writer, a built-in writer that is unknown, or one that does not belong to the reader.
std::optional<BuiltinTopic> topic_of(const EntityId& reader, const EntityId& writer);

}  // namespace swiftlet::rtps

#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::rtps {
namespace {

struct BuiltinWriter {
  EntityId writer;
  BuiltinTopic topic;
};
constexpr BuiltinWriter kWriters[] = {
    {kParticipantWriter, BuiltinTopic::kParticipant},
    {{0x00, 0x00, 0x03, 0xc2}, BuiltinTopic::kEndpoint},
    {{0x00, 0x00, 0x04, 0xc2}, BuiltinTopic::kEndpoint},
    {{0x00, 0x02, 0x00, 0xc2}, BuiltinTopic::kLiveliness},
    {{0x00, 0x02, 0x01, 0xc3}, BuiltinTopic::kHandshake},
    {{0xff, 0x02, 0x02, 0xc3}, BuiltinTopic::kSecurity},
    {{0xff, 0x01, 0x01, 0xc2}, BuiltinTopic::kSecurity},
    {{0xff, 0x00, 0x03, 0xc2}, BuiltinTopic::kSecurity},
    {{0xff, 0x00, 0x04, 0xc2}, BuiltinTopic::kSecurity},
    {{0xff, 0x02, 0x00, 0xc2}, BuiltinTopic::kSecurity},
};

// The reader of a built-in writer has the same number, and a kind higher by 5 (without key: by 1).
bool is_counterpart(const EntityId& reader, const EntityId& writer) {
  const std::uint8_t kind = writer[3] == 0xc2 ? 0xc7 : 0xc4;
  return reader == EntityId{writer[0], writer[1], writer[2], kind};
}

}  // namespace

bool is_discovery_server(const GuidPrefix& participant) {
  constexpr GuidPrefix kServer{0x44, 0x53, 0, 0x5f, 0x45, 0x50, 0x52, 0x4f, 0x53, 0x49, 0x4d, 0x41};
  GuidPrefix numberless = participant;
  numberless[2] = 0;
  return numberless == kServer;
}

bool is_writer(const EntityId& entity) {
  const unsigned kind = entity[3] & 0x3fU;
  return kind == 0x02 || kind == 0x03;  // with and without key
}

std::optional<BuiltinTopic> topic_of(const EntityId& reader, const EntityId& writer) {
  if (!is_writer(writer)) return std::nullopt;
  if (!is_builtin(writer)) {
    if (is_builtin(reader)) return std::nullopt;
    return BuiltinTopic::kUser;
  }
  for (const BuiltinWriter& known : kWriters) {
    if (writer == known.writer && (reader == kUnknownEntity || is_counterpart(reader, writer)))
      return known.topic;
  }
  return std::nullopt;
}

}  // namespace swiftlet::rtps

// Section numbers are those of "DDS Interoperability Wire Protocol (DDSI-RTPS)", version 2.5.
#include "swiftlet/services/rtps/check.hpp"

#include <algorithm>
#include <optional>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/rtps/datagram_seal.hpp"
#include "swiftlet/services/rtps/key_rules.hpp"
#include "swiftlet/services/rtps/parameter_list.hpp"
#include "swiftlet/services/rtps/submessage.hpp"

namespace swiftlet::rtps {
namespace {

constexpr std::uint8_t kRtpsMagic[] = {'R', 'T', 'P', 'S', 2};  // 9.4.4: protocol, major version
constexpr std::size_t kStatisticsBytes = 4 + 56;                // with its header

// Bits of the flags of a submessage.
constexpr std::uint8_t kInlineQosFlag = 2;
constexpr std::uint8_t kInvalidateFlag = 2;   // of INFO_TS
constexpr std::uint8_t kDataFlag = 4;         // of DATA
constexpr std::uint8_t kKeyFlag = 8;          // of DATA
constexpr std::uint8_t kFragmentKeyFlag = 4;  // of DATA_FRAG

// Fast DDS keeps a number of its own in each missing fragment.
constexpr std::uint32_t kSmallestFragment = 1024;
constexpr std::uint32_t kSmallestLastFragment = 4;
// Fast DDS keeps each sample of a gap in memory.
constexpr std::uint32_t kLongestGap = 256;
constexpr std::uint32_t kMostNumbers = 256;  // of a set (9.4.2.6)

struct Submessage {
  std::uint8_t kind;
  std::uint8_t flags;
  ByteReader body;

  bool has(std::uint8_t flag) const { return (flags & flag) != 0; }
};

// A sequence number (9.4.2.4). Fast DDS adds to them without checking for overflow: those with a high word, of
// writers of more than 4 billion samples, are out of range here.
struct SequenceNumber {
  bool in_range;
  std::uint32_t value;
};

SequenceNumber sequence_number(ByteReader& in) {
  const std::uint32_t high = in.u32();
  const std::uint32_t low = in.u32();
  return {high == 0 && low != 0xffffffff, low};
}

// Returns how many numbers the part of a set that follows its first number is about.
std::uint32_t skip_bitmap(ByteReader& in) {
  const std::uint32_t numbers = in.u32();
  in.skip(numbers <= kMostNumbers ? (numbers + 31) / 32 * 4 : 0);
  return numbers;
}

// With security, what may stand outside an encrypted message: announcements, handshakes, and what is itself encrypted.
bool may_be_clear(std::uint8_t kind) {
  return kind == kPad || kind == kInfoTimestamp || kind == kInfoDestination || kind == kData ||
         (kind >= kSecureBody && kind <= kSecureRtpsPrefix);
}

const char* check_writer(const EntityId& entity) {
  return is_writer(entity) ? nullptr : "submessage of a writer that is none (9.3.1.2)";
}

// Checks one datagram. All check functions return the broken rule, or nullptr.
class DatagramCheck {
 public:
  DatagramCheck(const std::uint8_t* data, std::size_t size, const DatagramLimits& limits)
      : begin_(data), limits_(limits), rest_(data, size, true) {
    result_.length = size;
  }

  CheckedDatagram run() {
    result_.fault = check_header();
    if (result_.fault == nullptr && rest_.rest() == 0) result_.fault = "message without submessages (8.3.3)";
    while (result_.fault == nullptr && rest_.rest() > 0) result_.fault = check_next();
    return result_;
  }

 private:
  const char* check_header();
  const char* check_next();
  const char* check_encryption(std::uint8_t kind);
  const char* check_body(Submessage& submessage);
  const char* check_destination(ByteReader body);
  const char* check_acknack(ByteReader body);
  const char* check_heartbeat(ByteReader body);
  const char* check_gap(ByteReader body);
  const char* check_nack_frag(ByteReader body);
  const char* check_data(Submessage& submessage);
  const char* check_payload(Submessage& submessage, const ListContext& context, bool names_key);
  const char* check_data_frag(Submessage& submessage);
  const char* check_fragments(ByteReader& body, std::uint64_t& payload_bytes);

  const std::uint8_t* begin_;
  const DatagramLimits& limits_;
  ByteReader rest_;
  CheckedDatagram result_;
  GuidPrefix destination_{};  // of what follows; all zeros: none is named
  bool encrypted_ = false;    // with security: what follows is the content of an encrypted message
};

const char* DatagramCheck::check_header() {
  const std::uint8_t* const header = rest_.take(kHeaderBytes);
  if (header == nullptr) return "shorter than the header of a message (8.3.6)";
  if (!std::equal(std::begin(kRtpsMagic), std::end(kRtpsMagic), header))
    return "not RTPS, version 2 (8.3.6.3)";
  std::copy_n(header + 8, result_.source.size(), result_.source.begin());
  if (result_.source == GuidPrefix{}) return "message of an unknown participant (8.3.6.3)";
  return nullptr;
}

const char* DatagramCheck::check_next() {
  if (rest_.rest() == kStatisticsBytes && *rest_.data() == kStatistics) {
    result_.length -= kStatisticsBytes;
    rest_.skip(kStatisticsBytes);
    return nullptr;
  }
  // Its sender refuses what this process answers: they would only half discover each other.
  if (rest_.rest() == kSealBytes && *rest_.data() == kSeal) return kNoKey;
  const std::uint8_t* const header = rest_.take(2);
  if (header == nullptr) return "submessage header too short (8.3.3.3)";
  ByteReader length_field(rest_.data(), rest_.rest(), (header[1] & kLittleEndianFlag) != 0);
  std::size_t length = length_field.u16();
  rest_.skip(2);
  if (!rest_.ok()) return "submessage header too short (8.3.3.3)";
  if (length == 0 && header[0] != kPad && header[0] != kInfoTimestamp) length = rest_.rest();  // to the end
  if (length > rest_.rest()) return "submessage longer than the message (9.4.5.1.3)";
  if (length % 4 != 0 && length != rest_.rest() && !encrypted_)
    return "submessage whose length is not a multiple of 4 (9.4.5.1.3)";
  Submessage submessage{header[0], header[1],
                        ByteReader(rest_.data(), length, (header[1] & kLittleEndianFlag) != 0)};
  rest_.skip(length);
  if (const char* const fault = check_encryption(submessage.kind)) return fault;
  return check_body(submessage);
}

const char* DatagramCheck::check_encryption(std::uint8_t kind) {
  const bool is_of_security = kind >= kSecureBody && kind <= kSecureRtpsPostfix;
  if (!limits_.security) return is_of_security ? kEncrypted : nullptr;
  if (encrypted_) {
    const bool belongs = kind == kSecureBody || kind == kSecureRtpsPostfix;
    return belongs ? nullptr : "submessage beside the content of an encrypted message (DDS Security 7.3.6)";
  }
  encrypted_ = kind == kSecureRtpsPrefix;
  return may_be_clear(kind) ? nullptr : kNotEncrypted;
}

const char* DatagramCheck::check_body(Submessage& submessage) {
  ByteReader& body = submessage.body;
  switch (submessage.kind) {
    case kAcknack:
      return check_acknack(body);
    case kHeartbeat:
      return check_heartbeat(body);
    case kGap:
      return check_gap(body);
    case kNackFrag:
      return check_nack_frag(body);
    case kData:
      return check_data(submessage);
    case kDataFrag:
      return check_data_frag(submessage);
    case kHeartbeatFrag:
      body.skip(24);
      return body.ok() ? nullptr : "HEARTBEAT_FRAG too short (8.3.8.7)";
    case kInfoDestination:
      return check_destination(body);
    case kInfoTimestamp:
      body.skip(submessage.has(kInvalidateFlag) ? 0 : 8);
      return body.ok() ? nullptr : "INFO_TS too short (8.3.8.11)";
    case kInfoSource:
      return "INFO_SRC, with which a datagram names another participant as its source (8.3.8.10)";
    case kStatistics:
      return "statistics submessage that is not the last (vendor-specific)";
    default:
      return nullptr;  // receivers skip other kinds (8.3.4.1), and the security plugin checks its own
  }
}

// All zeros leave the destination as it is in Fast DDS.
const char* DatagramCheck::check_destination(ByteReader body) {
  GuidPrefix destination{};
  const std::uint8_t* const bytes = body.take(destination.size());
  if (bytes == nullptr) return "INFO_DST too short (8.3.8.8)";
  std::copy_n(bytes, destination.size(), destination.begin());
  if (destination != GuidPrefix{}) destination_ = destination;
  return nullptr;
}

const char* DatagramCheck::check_acknack(ByteReader body) {
  body.skip(8);
  const SequenceNumber base = sequence_number(body);
  if (skip_bitmap(body) > kMostNumbers) return "ACKNACK with a set of more than 256 numbers (9.4.2.6)";
  body.skip(4);
  if (!body.ok()) return "ACKNACK too short (8.3.8.1)";
  return base.in_range ? nullptr : "ACKNACK with a sequence number out of range (8.3.5.5)";
}

const char* DatagramCheck::check_heartbeat(ByteReader body) {
  entity_id(body);
  const EntityId writer = entity_id(body);
  const SequenceNumber first = sequence_number(body);
  const SequenceNumber last = sequence_number(body);
  body.skip(4);
  if (!body.ok()) return "HEARTBEAT too short (8.3.8.6)";
  if (!first.in_range || !last.in_range) return "HEARTBEAT with a sequence number out of range (8.3.5.5)";
  if (first.value == 0 || last.value + 1 < first.value)
    return "HEARTBEAT that ends before it begins (8.3.8.6.3)";
  return check_writer(writer);
}

const char* DatagramCheck::check_gap(ByteReader body) {
  entity_id(body);
  const EntityId writer = entity_id(body);
  const SequenceNumber start = sequence_number(body);
  const SequenceNumber base = sequence_number(body);
  const std::uint32_t numbers = skip_bitmap(body);
  if (numbers > kMostNumbers) return "GAP with a set of more than 256 numbers (9.4.2.6)";
  if (!body.ok()) return "GAP too short (8.3.8.4)";
  if (!start.in_range || !base.in_range) return "GAP with a sequence number out of range (8.3.5.5)";
  if (start.value == 0 || base.value < start.value) return "GAP that ends before it begins (8.3.8.4.3)";
  if (base.value - start.value > (is_builtin(writer) ? kLongestBuiltinGap : kLongestGap))
    return "GAP of more than 256 samples, or of discovery 65,536 (8.3.8.4)";
  if (result_.gaps.size() == result_.gaps.capacity()) return "more than 32 GAP";
  result_.gaps.push_back({writer, base.value + numbers});
  return check_writer(writer);
}

const char* DatagramCheck::check_nack_frag(ByteReader body) {
  entity_id(body);
  const EntityId writer = entity_id(body);
  const SequenceNumber sample = sequence_number(body);
  const std::uint64_t base = body.u32();
  const std::uint32_t numbers = skip_bitmap(body);
  if (numbers > kMostNumbers) return "NACK_FRAG with a set of more than 256 numbers (9.4.2.8)";
  body.skip(4);
  if (!body.ok()) return "NACK_FRAG too short (8.3.8.12)";
  if (!sample.in_range || sample.value == 0) return "NACK_FRAG with a sequence number out of range (8.3.5.5)";
  const std::uint64_t last = base + std::max(numbers, 1U) - 1;
  if (base == 0 || last > limits_.largest_sample_bytes / kSmallestFragment)
    return "NACK_FRAG of fragments that no sample has (9.4.2.8)";
  if (result_.requests.size() == result_.requests.capacity()) return "more than 8 NACK_FRAG";
  result_.requests.push_back({destination_, writer, sample.value, static_cast<std::uint32_t>(last)});
  return nullptr;
}

const char* DatagramCheck::check_data(Submessage& submessage) {
  ByteReader& body = submessage.body;
  body.skip(2);
  const bool at_known_place = body.u16() == 16;
  const EntityId reader = entity_id(body);
  const EntityId writer = entity_id(body);
  const SequenceNumber number = sequence_number(body);
  if (!body.ok()) return "DATA too short (8.3.8.2)";
  if (!at_known_place) return "DATA with inline QoS at an unknown place (9.4.5.4)";
  if (!number.in_range || number.value == 0) return "DATA with a sequence number out of range (8.3.5.5)";
  if (submessage.has(kDataFlag) && submessage.has(kKeyFlag)) return "DATA with both data and key (8.3.8.2.2)";
  const std::optional<BuiltinTopic> topic = topic_of(reader, writer);
  if (!topic) return "DATA between endpoints that do not belong together (9.3.1.3)";
  const bool of_security = *topic == BuiltinTopic::kSecurity || *topic == BuiltinTopic::kHandshake;
  if (of_security && !limits_.security) return kSecurityData;
  if (limits_.security && *topic != BuiltinTopic::kParticipant && *topic != BuiltinTopic::kHandshake)
    return kDataNotEncrypted;
  const bool relays = limits_.discovery_servers && is_discovery_server(result_.source);
  const ListContext context{begin_, result_.source, *topic, limits_.security, relays};
  bool names_key = false;
  if (submessage.has(kInlineQosFlag)) {
    if (const char* const fault = check_inline_qos(body, context, names_key)) return fault;
  }
  if (const char* const fault = check_payload(submessage, context, names_key)) return fault;
  return check_writer(writer);
}

const char* DatagramCheck::check_payload(Submessage& submessage, const ListContext& context, bool names_key) {
  const ByteReader& payload = submessage.body;
  const bool of_discovery =
      context.topic == BuiltinTopic::kParticipant || context.topic == BuiltinTopic::kEndpoint;
  if (!submessage.has(kDataFlag | kKeyFlag))
    return of_discovery && !names_key ? "discovery data without GUID (9.6.3)" : nullptr;
  if (payload.rest() < 4) return "payload shorter than its encapsulation (10.2)";
  if (of_discovery) {
    const bool key_only = submessage.has(kKeyFlag);
    Announced announced;
    if (const char* const fault =
            check_discovery_payload(payload, context, key_only, result_.places, announced))
      return fault;
    if (context.topic == BuiltinTopic::kParticipant && !key_only && !context.relays) {
      result_.announces_itself = true;
      result_.announced = announced;
    }
  }
  if (context.topic == BuiltinTopic::kHandshake) {
    result_.handshake = true;
    return check_handshake_payload(payload);
  }
  if (context.topic == BuiltinTopic::kLiveliness) return check_liveliness_payload(payload, context);
  return nullptr;
}

const char* DatagramCheck::check_data_frag(Submessage& submessage) {
  ByteReader& body = submessage.body;
  body.skip(2);
  const bool at_known_place = body.u16() == 28;
  const EntityId reader = entity_id(body);
  const EntityId writer = entity_id(body);
  const SequenceNumber number = sequence_number(body);
  std::uint64_t payload_bytes = 0;
  if (const char* const fault = check_fragments(body, payload_bytes)) return fault;
  if (!at_known_place) return "DATA_FRAG with inline QoS at an unknown place (9.4.5.5)";
  if (!number.in_range || number.value == 0) return "DATA_FRAG with a sequence number out of range (8.3.5.5)";
  if (topic_of(reader, writer) != BuiltinTopic::kUser) return "DATA_FRAG of a built-in endpoint (9.3.1.3)";
  if (submessage.has(kFragmentKeyFlag)) return "DATA_FRAG of a key (9.4.5.5)";
  bool names_key = false;
  const ListContext context{begin_, result_.source, BuiltinTopic::kUser, limits_.security, false};
  if (submessage.has(kInlineQosFlag)) {
    if (const char* const fault = check_inline_qos(body, context, names_key)) return fault;
  }
  result_.fragment = true;
  if (body.rest() < payload_bytes) return "DATA_FRAG with less data than its fragments have (8.3.8.3.3)";
  return check_writer(writer);
}

const char* DatagramCheck::check_fragments(ByteReader& body, std::uint64_t& payload_bytes) {
  const std::uint64_t start = body.u32();
  const std::uint64_t count = body.u16();
  const std::uint64_t size = body.u16();
  const std::uint64_t sample = body.u32();
  if (!body.ok()) return "DATA_FRAG too short (8.3.8.3)";
  if (size < kSmallestFragment || sample <= size || sample > limits_.largest_sample_bytes)
    return "DATA_FRAG with fragments or a sample of an unusual size (8.3.8.3.3)";
  if (sample % size != 0 && sample % size < kSmallestLastFragment)
    return "DATA_FRAG whose last fragment is shorter than 4 bytes (8.3.8.3.3)";
  const std::uint64_t fragments = (sample + size - 1) / size;
  if (count != 1) return "DATA_FRAG of several fragments (8.3.8.3)";
  if (start == 0 || start > fragments)
    return "DATA_FRAG with a fragment that the sample does not have (8.3.8.3.3)";
  payload_bytes = std::min(size, sample - (start - 1) * size);
  return nullptr;
}

}  // namespace

CheckedDatagram check_datagram(const std::uint8_t* data, std::size_t size, const DatagramLimits& limits) {
  return DatagramCheck(data, size, limits).run();
}

void remove_statistics(std::vector<std::uint8_t>& message) {
  if (message.size() < kHeaderBytes + kStatisticsBytes) return;
  const auto begin = message.end() - static_cast<std::ptrdiff_t>(kStatisticsBytes);
  const int length = begin[2] + begin[3];  // in either byte order
  const bool is_empty = std::all_of(begin + 4, message.end(), [](std::uint8_t byte) { return byte == 0; });
  if (begin[0] == kStatistics && length == kStatisticsBytes - 4 && is_empty)
    message.erase(begin, message.end());
}

void hide_parameters(const CheckedDatagram& checked, std::uint8_t* copy) {
  for (const std::size_t at : checked.places.hidden) {
    copy[at] = 0;
    copy[at + 1] = 0;
  }
}

void name_source(const CheckedDatagram& checked, Ipv4 address, std::uint8_t* copy) {
  for (const std::size_t at : checked.places.loopback) {
    for (unsigned byte = 0; byte < 4; ++byte)
      copy[at + byte] = static_cast<std::uint8_t>(address >> (24U - 8U * byte));
  }
}

}  // namespace swiftlet::rtps

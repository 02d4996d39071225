// Section numbers are those of "DDS Interoperability Wire Protocol (DDSI-RTPS)", version 2.5.
#include "swiftlet/services/rtps/parameter_list.hpp"

#include <algorithm>
#include <iterator>

#include "swiftlet/services/rtps/key_rules.hpp"

namespace swiftlet::rtps {
namespace {

constexpr std::uint16_t kSentinel = 0x0001;
constexpr std::uint16_t kKeyHash = 0x0070;
constexpr std::uint16_t kUserData = 0x002c;
constexpr std::uint16_t kEndpointLocator = 0x002f;
constexpr std::uint16_t kSamplesLocator = 0x0031;
constexpr std::uint16_t kDiscoveryLocator = 0x0032;
constexpr std::uint16_t kEntityName = 0x0062;
constexpr std::uint32_t kUdpV4 = 1;       // kind of a locator
constexpr int kMostParameters = 256;      // of a list
constexpr std::uint32_t kMostTokens = 8;  // of a handshake
// A shorter lease of a participant would end between two of its announcements.
constexpr std::int32_t kShortestLease_s = 1;
// The longest lease that an implementation of DDS has by default.
constexpr std::int32_t kLongestLease_s = 300;

// What a parameter holds.
enum class Shape {
  kFixed,  // at least so many bytes
  kString,
  kStrings,      // sequence<string>
  kStringPairs,  // sequence<struct {string; string}>
  kSequence,     // sequence of elements of so many bytes
  kGuid,         // of the source of the datagram
  kLease,
  kToken,  // of DDS Security
  kHidden,
};

struct ParameterRule {
  std::uint16_t id;
  Shape shape;
  std::uint8_t bytes;
};

// 9.6.3.2, and vendor-specific ones of Fast DDS. Others are skipped by the middleware.
constexpr ParameterRule kRules[] = {
    {0x0002, Shape::kLease, 8},        // PID_PARTICIPANT_LEASE_DURATION
    {0x0005, Shape::kString, 0},       // PID_TOPIC_NAME
    {0x0006, Shape::kFixed, 4},        // PID_OWNERSHIP_STRENGTH
    {0x0007, Shape::kString, 0},       // PID_TYPE_NAME
    {0x000f, Shape::kFixed, 4},        // PID_DOMAIN_ID
    {0x0015, Shape::kFixed, 2},        // PID_PROTOCOL_VERSION
    {0x0016, Shape::kFixed, 2},        // PID_VENDORID
    {0x001a, Shape::kFixed, 12},       // PID_RELIABILITY
    {0x001b, Shape::kFixed, 12},       // PID_LIVELINESS
    {0x001d, Shape::kFixed, 4},        // PID_DURABILITY
    {0x001e, Shape::kFixed, 28},       // PID_DURABILITY_SERVICE
    {0x001f, Shape::kFixed, 4},        // PID_OWNERSHIP
    {0x0021, Shape::kFixed, 8},        // PID_PRESENTATION
    {0x0023, Shape::kFixed, 8},        // PID_DEADLINE
    {0x0025, Shape::kFixed, 4},        // PID_DESTINATION_ORDER
    {0x0027, Shape::kFixed, 8},        // PID_LATENCY_BUDGET
    {0x0029, Shape::kStrings, 0},      // PID_PARTITION
    {0x002b, Shape::kFixed, 8},        // PID_LIFESPAN
    {kUserData, Shape::kSequence, 1},  // PID_USER_DATA
    {0x002d, Shape::kSequence, 1},     // PID_GROUP_DATA
    {0x002e, Shape::kSequence, 1},     // PID_TOPIC_DATA
    {0x002f, Shape::kFixed, 24},       // PID_UNICAST_LOCATOR
    {0x0030, Shape::kFixed, 24},       // PID_MULTICAST_LOCATOR
    {0x0031, Shape::kFixed, 24},       // PID_DEFAULT_UNICAST_LOCATOR
    {0x0032, Shape::kFixed, 24},       // PID_METATRAFFIC_UNICAST_LOCATOR
    {0x0033, Shape::kFixed, 24},       // PID_METATRAFFIC_MULTICAST_LOCATOR
    {0x0034, Shape::kFixed, 4},        // PID_PARTICIPANT_MANUAL_LIVELINESS_COUNT
    {0x0035, Shape::kHidden, 0},       // PID_CONTENT_FILTER_PROPERTY
    {0x0043, Shape::kFixed, 1},        // PID_EXPECTS_INLINE_QOS
    {0x0048, Shape::kFixed, 24},       // PID_DEFAULT_MULTICAST_LOCATOR
    {0x0050, Shape::kGuid, 16},        // PID_PARTICIPANT_GUID
    {0x0058, Shape::kFixed, 4},        // PID_BUILTIN_ENDPOINT_SET
    {0x0059, Shape::kStringPairs, 0},  // PID_PROPERTY_LIST
    {0x005a, Shape::kGuid, 16},        // PID_ENDPOINT_GUID
    {0x0060, Shape::kFixed, 4},        // PID_TYPE_MAX_SIZE_SERIALIZED
    {kEntityName, Shape::kString, 0},  // PID_ENTITY_NAME
    {0x0069, Shape::kHidden, 0},       // PID_TYPE_IDV1
    {kKeyHash, Shape::kGuid, 16},      // PID_KEY_HASH
    {0x0071, Shape::kFixed, 4},        // PID_STATUS_INFO
    {0x0072, Shape::kHidden, 0},       // PID_TYPE_OBJECTV1
    {0x0073, Shape::kSequence, 2},     // PID_DATA_REPRESENTATION
    {0x0074, Shape::kFixed, 4},        // PID_TYPE_CONSISTENCY_ENFORCEMENT
    {0x0075, Shape::kHidden, 0},       // PID_TYPE_INFORMATION
    {0x0083, Shape::kFixed, 24},       // PID_RELATED_SAMPLE_IDENTITY
    {0x1001, Shape::kToken, 0},        // PID_IDENTITY_TOKEN
    {0x1002, Shape::kToken, 0},        // PID_PERMISSIONS_TOKEN
    {0x1004, Shape::kToken, 8},        // PID_ENDPOINT_SECURITY_INFO
    {0x1005, Shape::kToken, 8},        // PID_PARTICIPANT_SECURITY_INFO
    {0x8000, Shape::kFixed, 4},        // PID_PRODUCT_VERSION
    {0x8002, Shape::kFixed, 16},       // PID_PERSISTENCE_GUID
    {0x8005, Shape::kFixed, 1},        // PID_DISABLE_POSITIVE_ACKS
    {0x8006, Shape::kSequence, 8},     // PID_DATASHARING
    {0x8007, Shape::kFixed, 4},        // PID_NETWORK_CONFIGURATION_SET
    {0x800f, Shape::kFixed, 24},       // PID_CUSTOM_RELATED_SAMPLE_IDENTITY
};

// Length with the terminating 0, the characters, and up to 3 bytes of padding.
bool skip_string(ByteReader& in) {
  const std::uint32_t length = in.u32();
  const std::uint8_t* const text = in.take(length);
  if (text == nullptr || (length > 0 && text[length - 1] != 0)) return false;
  in.skip(std::min<std::size_t>((4 - length % 4) % 4, in.rest()));
  return true;
}

bool skip_strings(ByteReader& in, std::uint32_t per_element) {
  const std::uint32_t count = in.u32();
  if (!in.ok() || count > in.rest() / 4) return false;
  for (std::uint32_t i = 0; i < count * per_element; ++i) {
    if (!skip_string(in)) return false;
  }
  return true;
}

bool skip_sequence(ByteReader& in, std::size_t element_bytes) {
  const std::uint32_t count = in.u32();
  if (!in.ok() || count > in.rest() / element_bytes) return false;
  in.skip(count * element_bytes);
  return true;
}

// DDS Security 1.1, 7.2.4: class_id, properties, and binary properties.
bool skip_token(ByteReader& in) {
  if (!skip_string(in) || !skip_strings(in, 2)) return false;
  const std::uint32_t count = in.u32();
  if (!in.ok() || count > in.rest() / 8) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!skip_string(in) || !skip_sequence(in, 1)) return false;
    in.skip(in.rest() % 4);  // up to the next multiple of 4: the length of the whole is one
  }
  return true;
}

// The key of a topic of discovery is a GUID of the participant that sends it.
bool is_own_guid(const std::uint8_t* guid, const ListContext& context) {
  if (!context.relays && !std::equal(context.source.begin(), context.source.end(), guid)) return false;
  return context.topic != BuiltinTopic::kParticipant ||
         std::equal(kParticipantEntity.begin(), kParticipantEntity.end(), guid + context.source.size());
}

const char* check_lease(ByteReader value) {
  const auto seconds = static_cast<std::int32_t>(value.u32());
  value.skip(4);  // the fraction of a second
  if (!value.ok() || seconds < kShortestLease_s || seconds > kLongestLease_s)
    return "participant with a lease that is not between 1 and 300 s (9.6.3.2)";
  return nullptr;
}

const char* check_guid(ByteReader value, const ListContext& context) {
  const std::uint8_t* const guid = value.take(16);
  if (guid == nullptr) return "parameter too short (9.4.2.11)";
  const bool of_discovery =
      context.topic == BuiltinTopic::kParticipant || context.topic == BuiltinTopic::kEndpoint;
  if (of_discovery && !is_own_guid(guid, context))
    return "discovery data about another participant (8.5.3, 8.5.4)";
  return nullptr;
}

const char* check_value(const ParameterRule& rule, ByteReader value, const ListContext& context) {
  bool valid = true;
  switch (rule.shape) {
    case Shape::kFixed:
      value.skip(rule.bytes);
      break;
    case Shape::kString:
      valid = skip_string(value);
      break;
    case Shape::kStrings:
      valid = skip_strings(value, 1);
      break;
    case Shape::kStringPairs:
      valid = skip_strings(value, 2);
      break;
    case Shape::kSequence:
      valid = skip_sequence(value, rule.bytes);
      break;
    case Shape::kGuid:
      return check_guid(value, context);
    case Shape::kLease:
      return check_lease(value);
    case Shape::kToken:
      if (!context.security) return kSecurityToken;
      rule.bytes > 0 ? value.skip(rule.bytes) : static_cast<void>(valid = skip_token(value));
      break;
    case Shape::kHidden:
      break;
  }
  return valid && value.ok() ? nullptr : "parameter whose content exceeds its length (9.4.2.11)";
}

struct Parameter {
  std::uint16_t id = kSentinel;
  const std::uint8_t* begin = nullptr;
  const ParameterRule* rule = nullptr;
  ByteReader value{nullptr, 0, true};
};

// Calls found(parameter) for each parameter with a rule. Leaves `list` behind the sentinel.
template <class Found>
const char* check_list(ByteReader& list, const ListContext& context, const Found& found) {
  for (int i = 0; i < kMostParameters; ++i) {
    Parameter parameter;
    parameter.begin = list.data();
    parameter.id = list.u16();
    const std::uint16_t length = list.u16();
    if (!list.ok()) return "parameter list without its end (9.4.2.11)";
    if (parameter.id == kSentinel) return nullptr;
    if (length % 4 != 0) return "parameter whose length is not a multiple of 4 (9.4.2.11)";
    const ByteReader value = list.part(length);
    if (!list.ok()) return "parameter longer than its list (9.4.2.11)";
    const auto* const rule = std::find_if(std::begin(kRules), std::end(kRules),
                                          [&](const auto& r) { return r.id == parameter.id; });
    if (rule == std::end(kRules)) continue;
    if (const char* const fault = check_value(*rule, value, context)) return fault;
    parameter.rule = rule;
    parameter.value = value;
    if (const char* const fault = found(parameter)) return fault;
  }
  return "parameter list of more than 256 parameters (9.4.2.11)";
}

bool is_unicast_locator(std::uint16_t id) {
  return id == kEndpointLocator || id == kSamplesLocator || id == kDiscoveryLocator;
}

// value: of a locator (9.3.2.4), behind its kind: the port, and an address whose last four bytes are those of IPv4.
void note_locator(std::uint16_t id, ByteReader value, const ListContext& context, PlacesToChange& places,
                  Announced& announced) {
  const std::uint32_t port = value.u32();
  value.skip(12);
  const std::uint8_t* const at = value.take(4);
  if (at == nullptr) return;
  const Ipv4 address = ByteReader(at, 4, false).u32();
  if (id == kDiscoveryLocator) announced.discovery_port = port;
  if (io::is_loopback(address)) {
    if (places.loopback.size() < places.loopback.capacity() && !context.relays)
      places.loopback.push_back(static_cast<std::size_t>(at - context.datagram));
  } else if (id == kSamplesLocator && announced.addresses.size() < announced.addresses.capacity()) {
    announced.addresses.push_back(address);
  }
}

}  // namespace

const char* check_inline_qos(ByteReader& body, const ListContext& context, bool& names_key) {
  return check_list(body, context, [&](const Parameter& parameter) -> const char* {
    names_key = names_key || parameter.id == kKeyHash;
    return nullptr;
  });
}

const char* check_discovery_payload(ByteReader payload, const ListContext& context, bool key_only,
                                    PlacesToChange& places, Announced& announced) {
  const std::uint8_t* const encapsulation = payload.take(4);  // 10.2: PL_CDR_BE or PL_CDR_LE, and two options
  if (encapsulation == nullptr || encapsulation[0] != 0 || (encapsulation[1] != 2 && encapsulation[1] != 3))
    return "discovery data that is not a parameter list (9.6.3)";
  ByteReader list(payload.data(), payload.rest(), encapsulation[1] == 3);
  bool names_key = false;
  const std::uint16_t key = context.topic == BuiltinTopic::kParticipant ? 0x0050 : 0x005a;
  const char* const fault = check_list(list, context, [&](const Parameter& parameter) -> const char* {
    names_key = names_key || parameter.id == key || (key_only && parameter.id == kKeyHash);
    ByteReader value = parameter.value;
    if (parameter.id == kEntityName) {
      announced.name_size = value.u32();
      announced.name = value.take(announced.name_size);
    } else if (parameter.id == kUserData) {
      announced.user_data_size = value.u32();
      announced.user_data = value.take(announced.user_data_size);
    } else if (is_unicast_locator(parameter.id) && value.u32() == kUdpV4) {
      note_locator(parameter.id, value, context, places, announced);
    }
    if (parameter.rule->shape != Shape::kHidden) return nullptr;
    if (places.hidden.size() == places.hidden.capacity())
      return "discovery data with more than 8 type descriptions (9.6.3.2)";
    places.hidden.push_back(static_cast<std::size_t>(parameter.begin - context.datagram));
    return nullptr;
  });
  if (fault != nullptr) return fault;
  return names_key ? nullptr : "discovery data without GUID (9.6.3)";
}

const char* check_liveliness_payload(ByteReader payload, const ListContext& context) {
  const std::uint8_t* const encapsulation = payload.take(4);
  const std::uint8_t* const participant = payload.take(context.source.size());
  payload.skip(4);  // kind
  if (!payload.ok() || encapsulation[0] != 0 || encapsulation[1] > 1)
    return "liveliness message too short (9.6.3.1)";
  if (!std::equal(context.source.begin(), context.source.end(), participant))
    return "liveliness of another participant (8.4.13)";
  ByteReader data(payload.data(), payload.rest(), encapsulation[1] == 1);
  return skip_sequence(data, 1) ? nullptr : "liveliness message too short (9.6.3.1)";
}

const char* check_handshake_payload(ByteReader payload) {
  constexpr std::size_t kMessageIdentityBytes = 24;
  constexpr std::size_t kGuidBytes = 16;
  const std::size_t bytes = payload.rest();
  const std::uint8_t* const encapsulation = payload.take(4);
  if (encapsulation == nullptr || encapsulation[0] != 0 || encapsulation[1] > 1 || bytes % 4 != 0)
    return "handshake that is not CDR (DDS Security 7.4.4)";
  ByteReader in(payload.data(), payload.rest(), encapsulation[1] == 1);
  in.skip(2 * kMessageIdentityBytes + 3 * kGuidBytes);
  if (!skip_string(in)) return "handshake too short (DDS Security 7.4.4)";
  const std::uint32_t tokens = in.u32();
  if (!in.ok() || tokens > kMostTokens) return "handshake with too many tokens (DDS Security 7.4.4)";
  for (std::uint32_t i = 0; i < tokens; ++i) {
    if (!skip_token(in) || !in.ok()) return "handshake whose content exceeds its length (DDS Security 7.4.4)";
  }
  return nullptr;
}

}  // namespace swiftlet::rtps

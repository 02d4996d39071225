// Checks of the parameter lists in DATA submessages: inline QoS, and what discovery sends about participants and
// endpoints.
#pragma once

#include <cstddef>
#include <cstdint>

#include <boost/container/static_vector.hpp>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::rtps {

using io::ByteReader;
using io::Ipv4;

// What to change in discovery data before the middleware parses it: places in the datagram.
struct PlacesToChange {
  // Where parameters begin that the middleware must not parse: it reads type descriptions and filter expressions without bounds
  // on depth and size, and nothing here needs them.
  boost::container::static_vector<std::size_t, 8> hidden;
  // Where the addresses of the loopback interface stand at which a process without a network, or an endpoint of it, says that it
  // receives; further ones are not noted.
  boost::container::static_vector<std::size_t, 8> loopback;
};

// What a participant announces about itself; null if it does not announce it.
struct Announced {
  const std::uint8_t* name = nullptr;
  std::size_t name_size = 0;  // with the terminating 0
  const std::uint8_t* user_data = nullptr;
  std::size_t user_data_size = 0;
  std::uint32_t discovery_port = 0;  // where it receives discovery by UDP; 0: it does not say
  // At which it receives samples, but for those of the loopback interface; further ones are not noted.
  boost::container::static_vector<Ipv4, 8> addresses;
};

// The DATA submessage that holds the list.
struct ListContext {
  const std::uint8_t* datagram = nullptr;
  GuidPrefix source{};  // of the datagram
  BuiltinTopic topic = BuiltinTopic::kUser;
  bool security = false;
  bool relays = false;  // the source may announce other participants
};

// All return the broken rule as a string literal, nullptr if there is none.

// Leaves `body` behind the list. names_key: set to true if it holds a key of the topic.
const char* check_inline_qos(ByteReader& body, const ListContext& context, bool& names_key);
// Checks a payload of the topics kParticipant and kEndpoint. key_only: it names what is gone, and holds no more.
const char* check_discovery_payload(ByteReader payload, const ListContext& context, bool key_only,
                                    PlacesToChange& places, Announced& announced);
// Checks a payload of the topic kLiveliness.
const char* check_liveliness_payload(ByteReader payload, const ListContext& context);
// Checks a payload of the topic kHandshake, a ParticipantGenericMessage of DDS Security 1.1, 7.4.4.
const char* check_handshake_payload(ByteReader payload);

}  // namespace swiftlet::rtps

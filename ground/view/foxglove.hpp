// The messages of the Foxglove WebSocket protocol, as far as the server speaks it
// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md). Texts are JSON; numbers of binary messages are
// little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "swiftlet/record/mcap/records.hpp"
#include "swiftlet/services/messages/schemas.hpp"

namespace swiftlet::ground::foxglove {

// A client must offer one of these. The first is the newer name of the same protocol.
constexpr std::array<const char*, 2> kSubprotocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"};

struct Channel {
  std::uint32_t id = 0;
  std::string topic;  // "/kl1/imu"
  const messages::MessageSchema* schema = nullptr;
};

struct Service {
  std::uint32_t id = 0;
  std::string name;           // "/kl1/hold"
  std::string type;           // "std_srvs/srv/Trigger"
  std::string request_type;   // "std_srvs/srv/Trigger_Request"
  std::string request;        // its definition
  std::string response_type;  // likewise
  std::string response;
};

enum class Level { kInfo = 0, kWarning = 1, kError = 2 };

// Texts to a client.
std::string server_info(const std::string& program, const std::string& session);
std::string advertise(const std::vector<Channel>& channels);
std::string advertise(const std::vector<Service>& services);
std::string status(Level level, const std::string& message);
std::string service_failure(std::uint32_t service, std::uint32_t call, const std::string& message);

// What stands before the payload of a message.
using MessageHead = std::array<std::uint8_t, 13>;
MessageHead message_head(std::uint32_t subscription, std::int64_t time_ns);

// A binary message with the response, as CDR.
mcap::Bytes service_response(std::uint32_t service, std::uint32_t call, const mcap::Bytes& response);

// What a client sends.
struct Subscription {
  std::uint32_t id = 0;  // chosen by the client
  std::uint32_t channel = 0;
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> subscriptions;
};
struct ServiceCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;  // chosen by the client
  std::string encoding;    // "cdr"
  mcap::Bytes request;
};
struct Fault {
  std::string message;  // a sentence
};
using ClientMessage = std::variant<Subscribe, Unsubscribe, ServiceCall, Fault>;

// Takes time in proportion to the size of the text, whatever is in it.
constexpr std::size_t kMostKeys = 16;  // of an object of a text; those that are known have two
ClientMessage parse_text(std::string_view text);
ClientMessage parse_binary(const std::uint8_t* data, std::size_t size);

}  // namespace swiftlet::ground::foxglove

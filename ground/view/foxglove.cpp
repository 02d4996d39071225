#include "swiftlet/ground/view/foxglove.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include <nlohmann/json.hpp>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground::foxglove {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint8_t kMessageData = 1;
constexpr std::uint8_t kServiceCallRequest = 2;
constexpr std::uint8_t kServiceCallResponse = 3;
constexpr const char* kEncoding = "cdr";
constexpr const char* kSchemaEncoding = "ros2msg";
constexpr std::size_t kMostDepth = 4;   // of JSON: a message has a list of objects
constexpr std::size_t kMostShown = 40;  // characters of what is refused

Json schema_of(const std::string& name, const std::string& definition) {
  return {{"encoding", kEncoding},
          {"schemaName", name},
          {"schemaEncoding", kSchemaEncoding},
          {"schema", definition}};
}

std::optional<std::uint32_t> id_of(const Json& json) {
  if (!json.is_number_unsigned()) return std::nullopt;
  const auto id = json.get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(id);
}

ClientMessage subscribe_of(const Json& json) {
  Subscribe subscribe;
  const auto list = json.find("subscriptions");
  if (list == json.end() || !list->is_array()) return Fault{"subscribe: subscriptions is not a list"};
  for (const Json& one : *list) {
    if (!one.is_object()) return Fault{"subscribe: a subscription is not an object"};
    const auto id = id_of(one.value("id", Json()));
    const auto channel = id_of(one.value("channelId", Json()));
    if (!id || !channel)
      return Fault{"subscribe: id and channelId must be whole numbers from 0 to 4294967295"};
    subscribe.subscriptions.push_back({*id, *channel});
  }
  return subscribe;
}

ClientMessage unsubscribe_of(const Json& json) {
  Unsubscribe unsubscribe;
  const auto list = json.find("subscriptionIds");
  if (list == json.end() || !list->is_array()) return Fault{"unsubscribe: subscriptionIds is not a list"};
  for (const Json& one : *list) {
    const auto id = id_of(one);
    if (!id) return Fault{"unsubscribe: an id must be a whole number from 0 to 4294967295"};
    unsubscribe.subscriptions.push_back(*id);
  }
  return unsubscribe;
}

}  // namespace

std::string server_info(const std::string& program, const std::string& session) {
  return io::json_text({{"op", "serverInfo"},
                        {"name", program},
                        {"capabilities", {"services"}},
                        {"supportedEncodings", {kEncoding}},
                        {"metadata", Json::object()},
                        {"sessionId", session}});
}

std::string advertise(const std::vector<Channel>& channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    Json entry = {{"id", channel.id}, {"topic", channel.topic}};
    entry.update(schema_of(channel.schema->name, channel.schema->definition));
    list.push_back(std::move(entry));
  }
  return io::json_text({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string advertise(const std::vector<Service>& services) {
  Json list = Json::array();
  for (const Service& service : services) {
    list.push_back({{"id", service.id},
                    {"name", service.name},
                    {"type", service.type},
                    {"request", schema_of(service.request_type, service.request)},
                    {"response", schema_of(service.response_type, service.response)},
                    {"requestSchema", service.request},
                    {"responseSchema", service.response}});
  }
  return io::json_text({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

std::string status(Level level, const std::string& message) {
  return io::json_text({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string service_failure(std::uint32_t service, std::uint32_t call, const std::string& message) {
  return io::json_text(
      {{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", message}});
}

MessageHead message_head(std::uint32_t subscription, std::int64_t time_ns) {
  MessageHead head{};
  head[0] = kMessageData;
  io::store(subscription, head.data() + 1);
  io::store(time_ns, head.data() + 1 + sizeof(subscription));
  return head;
}

mcap::Bytes service_response(std::uint32_t service, std::uint32_t call, const mcap::Bytes& response) {
  const std::string_view encoding = kEncoding;
  mcap::Bytes out = {kServiceCallResponse};
  io::append(out, service);
  io::append(out, call);
  io::append(out, static_cast<std::uint32_t>(encoding.size()));
  out.insert(out.end(), encoding.begin(), encoding.end());
  out.insert(out.end(), response.begin(), response.end());
  return out;
}

ClientMessage parse_text(std::string_view text) {
  // What is nested deeper is left out: to destroy it would take the stack. So are more keys: each is compared with
  // all before it.
  std::array<std::size_t, kMostDepth + 2> keys{};  // of the object that is read, by depth
  bool has_too_many_keys = false;
  const auto is_kept = [&](int of, Json::parse_event_t event, const Json&) {
    const auto depth = static_cast<std::size_t>(of);
    if (depth > kMostDepth) return false;
    if (event == Json::parse_event_t::object_start) keys[depth + 1] = 0;
    if (event != Json::parse_event_t::key || ++keys[depth] <= kMostKeys) return true;
    has_too_many_keys = true;
    return false;
  };
  const Json json = Json::parse(text, is_kept, false);
  if (has_too_many_keys)
    return Fault{"an object of the message has more than " + std::to_string(kMostKeys) + " keys"};
  if (!json.is_object()) return Fault{"the message is not a JSON object"};
  const std::string op = io::json_text(json.value("op", Json()));
  if (op == "\"subscribe\"") return subscribe_of(json);
  if (op == "\"unsubscribe\"") return unsubscribe_of(json);
  return Fault{"op " + op.substr(0, kMostShown) + " is not served: only subscribe and unsubscribe are"};
}

ClientMessage parse_binary(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHead = 1 + 3 * sizeof(std::uint32_t);
  if (size < kHead || data[0] != kServiceCallRequest) return Fault{"the binary message is no service call"};
  ServiceCall call;
  io::ByteReader in(data + 1, size - 1, true);
  call.service = in.u32();
  call.call = in.u32();
  const std::size_t length = in.u32();
  if (length > in.rest()) return Fault{"the encoding of the service call is cut off"};
  call.encoding.assign(data + kHead, data + kHead + length);
  call.request.assign(data + kHead + length, data + size);
  return call;
}

}  // namespace swiftlet::ground::foxglove

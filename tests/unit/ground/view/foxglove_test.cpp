#include "swiftlet/ground/view/foxglove.hpp"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::ground::foxglove::foxglove_test {

using nlohmann::json;

std::string fault_of(const ClientMessage& message) {
  const auto* const fault = std::get_if<Fault>(&message);
  return fault == nullptr ? "" : fault->message;
}

TEST(Foxglove, TellsOfTheServerItsChannelsAndServices) {
  const json info = json::parse(server_info("swiftlet 1", "ab"));
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_EQ(info.at("capabilities"), json({"services"}));
  EXPECT_EQ(info.at("supportedEncodings"), json({"cdr"}));
  EXPECT_EQ(info.at("sessionId"), "ab");

  const auto& schema = messages::schema_of<messages::msg::Imu>();
  const json channel = json::parse(advertise({Channel{3, "/kl1/imu", &schema}})).at("channels").at(0);
  EXPECT_EQ(channel, json({{"id", 3},
                           {"topic", "/kl1/imu"},
                           {"encoding", "cdr"},
                           {"schemaName", "swiftlet_msgs/msg/Imu"},
                           {"schemaEncoding", "ros2msg"},
                           {"schema", schema.definition}}));

  const Service stop{2, "/kl1/stop", "std_srvs/srv/SetBool", "A", "bool data\n", "B", "bool success\n"};
  const json service = json::parse(advertise({stop})).at("services").at(0);
  EXPECT_EQ(service.at("name"), "/kl1/stop");
  EXPECT_EQ(service.at("request").at("schema"), "bool data\n");
  EXPECT_EQ(service.at("response").at("schemaName"), "B");
}

TEST(Foxglove, WritesStatusesOfAnyText) {
  const json said = json::parse(status(Level::kWarning, "cut off: \xc3"));
  EXPECT_EQ(said.at("level"), 1);
  EXPECT_EQ(said.at("message"), "cut off: \xef\xbf\xbd");
  EXPECT_EQ(json::parse(service_failure(1, 2, "no")).at("callId"), 2);
}

TEST(Foxglove, WritesBinaryMessages) {
  const MessageHead head = message_head(0x01020304, 0x1122334455667788);
  const MessageHead expected = {1, 4, 3, 2, 1, 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11};
  EXPECT_EQ(head, expected);
  const mcap::Bytes response = service_response(5, 6, {0, 1, 0, 0, 1});
  const mcap::Bytes bytes = {3, 5, 0, 0, 0, 6, 0, 0, 0, 3, 0, 0, 0, 'c', 'd', 'r', 0, 1, 0, 0, 1};
  EXPECT_EQ(response, bytes);
}

TEST(Foxglove, LeavesOutWhatIsNestedDeep) {
  const std::string deep = std::string(30'000, '[') + std::string(30'000, ']');
  EXPECT_EQ(fault_of(parse_text(deep)), "the message is not a JSON object");
  EXPECT_EQ(fault_of(parse_text("{\"op\":" + deep + "}")).substr(0, 3), "op ");
  EXPECT_EQ(
      fault_of(parse_text(R"({"op":"subscribe","subscriptions":[{"id":)" + deep + R"(,"channelId":1}]})")),
      "subscribe: id and channelId must be whole numbers from 0 to 4294967295");
}

// Each key of an object is compared with those before it.
TEST(Foxglove, RefusesObjectsWithManyKeys) {
  const auto with = [](std::size_t more) {
    std::string keys;
    for (std::size_t i = 0; i < more; ++i) keys += ",\"" + std::to_string(i) + "\":1";
    return keys;
  };
  const auto top = [&](std::size_t keys) {
    return parse_text(R"({"op":"subscribe","subscriptions":[])" + with(keys - 2) + "}");
  };
  const auto inner = [&](std::size_t keys) {
    const std::string one = R"({"id":1,"channelId":1)" + with(keys - 2) + "}";
    return parse_text(R"({"op":"subscribe","subscriptions":[)" + one + "," + one + "]}");
  };
  const std::string refusal = "an object of the message has more than 16 keys";
  EXPECT_EQ(fault_of(top(kMostKeys)), "");
  EXPECT_EQ(fault_of(inner(kMostKeys)), "") << "of each of two";
  EXPECT_EQ(fault_of(top(kMostKeys + 1)), refusal);
  EXPECT_EQ(fault_of(inner(kMostKeys + 1)), refusal);
  EXPECT_EQ(fault_of(top(7200)), refusal);
}

TEST(Foxglove, ReadsSubscriptions) {
  const auto subscribe = std::get<Subscribe>(parse_text(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":7},{"id":4294967295,"channelId":8}]})"));
  ASSERT_EQ(subscribe.subscriptions.size(), 2U);
  EXPECT_EQ(subscribe.subscriptions[0].channel, 7U);
  EXPECT_EQ(subscribe.subscriptions[1].id, 4294967295U);
  const auto unsubscribe =
      std::get<Unsubscribe>(parse_text(R"({"op":"unsubscribe","subscriptionIds":[1,2]})"));
  EXPECT_EQ(unsubscribe.subscriptions, (std::vector<std::uint32_t>{1, 2}));
}

TEST(Foxglove, SaysWhatIsWrongWithAText) {
  for (const char* text :
       {"", "no JSON", "[]", "{}", "\xff", R"({"op":7})", R"({"op":"advertise","channels":[]})",
        R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
        R"({"op":"subscribe","subscriptions":[1]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":"a","channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":[null]})", R"({"op":"unsubscribe"})"})
    EXPECT_NE(fault_of(parse_text(text)), "") << text;
  const std::string deep(100'000, '[');
  EXPECT_NE(fault_of(parse_text(deep)), "");
}

TEST(Foxglove, ReadsServiceCalls) {
  const mcap::Bytes bytes = {2, 5, 0, 0, 0, 6, 0, 0, 0, 3, 0, 0, 0, 'c', 'd', 'r', 0, 1, 0, 0, 1};
  const auto call = std::get<ServiceCall>(parse_binary(bytes.data(), bytes.size()));
  EXPECT_EQ(call.service, 5U);
  EXPECT_EQ(call.call, 6U);
  EXPECT_EQ(call.encoding, "cdr");
  EXPECT_EQ(call.request, (mcap::Bytes{0, 1, 0, 0, 1}));
  for (std::size_t size = 0; size < 16; ++size)
    EXPECT_NE(fault_of(parse_binary(bytes.data(), size)), "") << size;
  mcap::Bytes other = bytes;
  other[0] = 1;
  EXPECT_NE(fault_of(parse_binary(other.data(), other.size())), "");
  other = bytes;
  other[12] = 255;
  EXPECT_NE(fault_of(parse_binary(other.data(), other.size())), "");
}

}  // namespace swiftlet::ground::foxglove::foxglove_test

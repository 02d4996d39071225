// The server over real sockets and topics. The test stands in for the vehicle, the browser and Foxglove.
#include "swiftlet/ground/view/view_server.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/view/vehicle_requests.hpp"
#include "swiftlet/ground/view/viewer.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/payload.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/foxglove_client.hpp"
#include "tests/support/private_domain.hpp"

namespace swiftlet::ground::view_server_test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace msg = messages::msg;
using asio::ip::tcp;
using boost::system::error_code;
using nlohmann::json;
using tests::eventually;
using tests::FoxgloveClient;

// A plain HTTP request; 0 if the server closes the connection instead of answering.
struct Answer {
  unsigned status = 0;
  std::string body;
};
Answer ask(std::uint16_t port, http::request<http::string_body> request) {
  asio::io_context io;
  tcp::socket socket(io);
  socket.connect({asio::ip::make_address("127.0.0.1"), port});
  error_code error;
  request.prepare_payload();
  http::write(socket, request, error);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  http::read(socket, buffer, parser, error);
  if (!parser.is_header_done()) return {};
  return {parser.get().result_int(), parser.get().body()};
}

class Server : public testing::Test {
 protected:
  Server() : context_(tests::settings_of("ground", lock_)), vehicle_(tests::settings_of("control", lock_)) {
    start({});
  }

  void start(ViewSettings settings) {
    server_.reset();
    settings.port = 0;
    if (settings.vehicles.empty()) settings.vehicles = {"kl1"};
    server_ = std::make_unique<ViewServer>(context_, settings,
                                           [this](const std::string& text) { said_.put(text); });
  }
  std::string host() const { return "localhost:" + std::to_string(server_->port()); }
  http::request<http::string_body> request(const std::string& target = "/") const {
    http::request<http::string_body> request(http::verb::get, target, 11);
    request.set(http::field::host, host());
    return request;
  }
  Answer ask(const http::request<http::string_body>& request) const {
    return view_server_test::ask(server_->port(), request);
  }
  std::unique_ptr<FoxgloveClient> client(const std::string& target = "/") const {
    auto client = std::make_unique<FoxgloveClient>(server_->port());
    EXPECT_TRUE(client->open(host(), "", target));
    client->greet();
    return client;
  }

  dds::DomainLock lock_;
  Context context_;
  dds::Node vehicle_;
  tests::Inbox<std::string> said_;
  std::unique_ptr<ViewServer> server_;
};

msg::Estimate estimate(std::uint64_t number) {
  msg::Estimate estimate;
  estimate.sequence_number(number);
  estimate.position_ned({1.0, 2.0, -3.0});
  return estimate;
}
std::uint64_t number_of(const FoxgloveClient::Message& message) {
  msg::Estimate estimate;
  EXPECT_TRUE(dds::from_payload(message.payload.data(), message.payload.size(), estimate));
  return estimate.sequence_number();
}
// Publishes estimates 1, 2, ... until this viewer has one: what is sent before server and vehicle have found each other is lost.
// Returns the number of the last.
std::uint64_t send_until_received(dds::Publisher<msg::Estimate>& publisher, FoxgloveClient& viewer) {
  std::uint64_t number = 0;
  std::atomic<bool> is_received{false};
  const auto sent = std::async(std::launch::async, [&] {
    eventually([&] {
      publisher.publish(estimate(++number));
      return is_received.load();
    });
  });
  EXPECT_TRUE(viewer.read_message());
  is_received = true;
  sent.wait();
  return number;
}

TEST_F(Server, ServesThePageOnly) {
  EXPECT_EQ(server_->url(), "http://127.0.0.1:" + std::to_string(server_->port()) + "/");
  const Answer page = ask(request());
  EXPECT_EQ(page.status, 200U);
  EXPECT_NE(page.body.find("<title>Swiftlet live</title>"), std::string::npos);
  EXPECT_EQ(ask(request("/other")).status, 404U);
  auto post = request();
  post.method(http::verb::post);
  EXPECT_EQ(ask(post).status, 405U);
  post.body() = "text";
  EXPECT_EQ(ask(post).status, 400U);
  auto large = request();
  large.set("Other", std::string(ViewServer::kMostRequestBytes, 'x'));
  EXPECT_EQ(ask(large).status, 431U);
  EXPECT_EQ(server_->totals().refused, 4U);
}

TEST_F(Server, RefusesPagesOfOthers) {
  auto page = request();
  page.set(http::field::origin, "http://evil.example");
  EXPECT_EQ(ask(page).status, 403U);
  page = request();
  page.set(http::field::host, "evil.example:80");
  EXPECT_EQ(ask(page).status, 403U);
  EXPECT_FALSE(FoxgloveClient(server_->port()).open(host(), "http://evil.example"));
  EXPECT_FALSE(FoxgloveClient(server_->port()).open("evil.example", "http://evil.example"));
  EXPECT_TRUE(FoxgloveClient(server_->port()).open(host(), "http://" + host()));
  ViewSettings settings;
  settings.origins = {"https://app.foxglove.dev"};
  start(settings);
  EXPECT_TRUE(FoxgloveClient(server_->port()).open(host(), "https://app.foxglove.dev"));
}

TEST_F(Server, NeedsATokenBeyondTheLoopbackInterface) {
  ViewSettings settings;
  settings.address = "0.0.0.0";
  start(settings);
  const std::string url = server_->url();
  const std::string target = url.substr(url.find("/?token="));
  EXPECT_EQ(ask(request()).status, 403U);
  EXPECT_EQ(ask(request("/?token=" + std::string(32, '0'))).status, 403U);
  EXPECT_EQ(ask(request(target)).status, 200U);
  EXPECT_FALSE(FoxgloveClient(server_->port()).open("lab1", "", "/"));
  EXPECT_TRUE(FoxgloveClient(server_->port()).open("lab1", "http://lab1", target));
}

TEST_F(Server, SaysThatItsPortIsInUse) {
  ViewSettings settings;
  settings.port = server_->port();
  try {
    const ViewServer second(context_, settings, {});
    FAIL() << "two servers at one port";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "127.0.0.1 port " + std::to_string(settings.port) + " cannot be used: Address already in use");
  }
}

TEST_F(Server, SpeaksBothSubprotocols) {
  FoxgloveClient newer(server_->port());
  EXPECT_TRUE(newer.open(host(), "", "/", "other, foxglove.sdk.v1,foxglove.websocket.v1"));
  EXPECT_EQ(newer.protocol(), "foxglove.sdk.v1");
  auto without = request();
  without.set(http::field::connection, "Upgrade");
  without.set(http::field::upgrade, "websocket");
  without.set(http::field::sec_websocket_version, "13");
  without.set(http::field::sec_websocket_key, "AAAAAAAAAAAAAAAAAAAAAA==");
  EXPECT_EQ(ask(without).body,
            "the WebSocket must offer the subprotocol foxglove.sdk.v1 or foxglove.websocket.v1\n");
  FoxgloveClient older(server_->port());
  EXPECT_TRUE(older.open(host()));
  EXPECT_EQ(older.protocol(), FoxgloveClient::kProtocol);
  EXPECT_FALSE(FoxgloveClient(server_->port()).open(host(), "", "/", "other"));
  EXPECT_FALSE(FoxgloveClient(server_->port()).open(host(), "", "/", ""));
}

TEST_F(Server, LimitsConnections) {
  std::vector<std::unique_ptr<FoxgloveClient>> clients;
  for (std::size_t i = 0; i < ViewServer::kMostConnections; ++i) clients.push_back(client());
  EXPECT_EQ(server_->totals().viewers, ViewServer::kMostConnections);
  EXPECT_EQ(ask(request()).status, 0U);
  EXPECT_EQ(server_->totals().refused, 1U);
  clients.pop_back();
  EXPECT_TRUE(eventually([&] { return ask(request()).status == 200U; }));
}

TEST_F(Server, DisconnectsWhoSendsTooMuch) {
  const auto calm = client();
  const auto hasty = client();
  while (hasty->send("{}")) {
  }
  const auto large = client();
  large->send(std::string(ViewServer::kMostMessageBytes + 1, ' '));
  EXPECT_FALSE(large->read_text().has_value());
  EXPECT_TRUE(eventually([&] { return server_->totals().viewers == 1; }));
  EXPECT_FALSE(said_.items().empty());
  calm->send("{}");
  EXPECT_EQ(calm->read_text()->at("message"), "op null is not served: only subscribe and unsubscribe are");
}

// GIVEN a viewer of few large messages THEN it is disconnected long before it has sent as many as it may send small ones.
TEST_F(Server, DisconnectsWhoSendsTooManyBytes) {
  const auto viewer = client();
  const std::string large(ViewServer::kMostMessageBytes, ' ');
  for (int i = 0; i < 500 && viewer->send(large); ++i) {
  }
  ASSERT_TRUE(eventually([&] { return server_->totals().viewers == 0; }));
  EXPECT_EQ(said_.items(), std::vector<std::string>{"a viewer is disconnected: it sends too much"});
}

// GIVEN a viewer that reads nothing WHEN its messages ask for more answers than are on their way to it at once THEN it is
// disconnected before they fill the memory.
TEST_F(Server, DisconnectsWhoDoesNotReadItsAnswers) {
  const auto viewer = client();
  constexpr std::uint32_t kUnknown = 4'294'900'000;
  json ids = json::array();
  for (std::size_t i = 0; i < Viewer::kMostRefusals; ++i) ids.push_back(kUnknown + i);
  const std::string message = json({{"op", "unsubscribe"}, {"subscriptionIds", ids}}).dump();
  for (int i = 0; i < 1000 && viewer->send(message); ++i) {
  }
  ASSERT_TRUE(eventually([&] { return server_->totals().viewers == 0; }));
  EXPECT_EQ(said_.items(),
            std::vector<std::string>{"a viewer is disconnected: the answers to its messages are not read"});
}

TEST_F(Server, TellsTheFirstFaultsOfAMessage) {
  const auto viewer = client();
  json ids = json::array();
  for (std::size_t i = 0; i < 2 * Viewer::kMostRefusals; ++i) ids.push_back(i);
  viewer->send(json({{"op", "unsubscribe"}, {"subscriptionIds", ids}}).dump());
  viewer->send("{}");
  for (std::size_t i = 0; i < Viewer::kMostRefusals; ++i)
    EXPECT_EQ(viewer->read_text()->at("message"),
              "unsubscribe: there is no subscription " + std::to_string(i));
  EXPECT_EQ(viewer->read_text()->at("message"), "op null is not served: only subscribe and unsubscribe are");
}

TEST_F(Server, RefusesSubscriptionsThatCannotBe) {
  const auto viewer = client();
  viewer->subscribe(1, 100'000);
  EXPECT_EQ(viewer->read_text()->at("message"), "subscribe: there is no channel 100000");
  viewer->subscribe(1, 0);
  viewer->subscribe(1, 1);
  EXPECT_EQ(viewer->read_text()->at("message"), "subscribe: subscription 1 exists");
  viewer->subscribe(2, 0);
  EXPECT_EQ(viewer->read_text()->at("message"), "subscribe: channel 0 has subscription 1 already");
  viewer->send(R"({"op":"unsubscribe","subscriptionIds":[1,2]})");
  EXPECT_EQ(viewer->read_text()->at("message"), "unsubscribe: there is no subscription 2");
}

// GIVEN a viewer of the payloads and one of the standard messages WHEN the vehicle publishes THEN both have them, and a
// viewer that comes later has the newest.
TEST_F(Server, SendsPayloadsAsTheyCameAndStandardMessages) {
  auto publisher = vehicle_.publish(messages::topics::kEstimate);
  const auto first = client();
  const auto second = client();
  first->subscribe(7, first->channel("/kl1/estimate"));
  second->subscribe(8, second->channel("/tf"));
  second->send("{}");
  EXPECT_EQ(second->read_text()->at("op"), "status") << "it was read, and what was sent before it";
  std::uint64_t number = send_until_received(publisher, *first);
  publisher.publish(estimate(++number));
  auto message = first->read_message();
  while (message && number_of(*message) < number) message = first->read_message();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->subscription, 7U);
  EXPECT_EQ(message->payload, dds::to_payload(estimate(number)));
  EXPECT_EQ(second->read_message()->subscription, 8U);
  const auto third = client();
  third->subscribe(9, third->channel("/kl1/estimate"));
  EXPECT_EQ(number_of(*third->read_message()), number);
}

TEST_F(Server, SendsTheNewestToWhoWantsNoMore) {
  auto publisher = vehicle_.publish(messages::topics::kEstimate);
  const auto viewer = client("/?newest");
  viewer->subscribe(1, viewer->channel("/kl1/estimate"));
  std::uint64_t number = send_until_received(publisher, *viewer);
  for (int i = 0; i < 100; ++i) publisher.publish(estimate(++number));
  std::uint64_t newest = 0;
  while (newest < number) {
    const std::uint64_t next = number_of(*viewer->read_message());
    ASSERT_GT(next, newest);
    newest = next;
  }
}

// GIVEN lines of a log before a viewer comes WHEN it subscribes THEN it gets them all, in their order.
TEST_F(Server, SendsTheLogToWhoComesLater) {
  auto acks = vehicle_.publish(messages::topics::kCommandAck);
  ASSERT_TRUE(eventually([&] { return acks.matched() == 2; })) << "the log and the vehicle's client";
  const auto first = client("/?newest");
  first->subscribe(1, first->channel("/kl1/log"));
  std::vector<std::vector<std::uint8_t>> lines;
  for (const char* reason : {"one", "two", "three"}) {
    msg::CommandAck ack;
    ack.reason(reason);
    acks.publish(ack);
  }
  for (int i = 0; i < 3; ++i) lines.push_back(first->read_message()->payload);
  EXPECT_NE(lines[0], lines[1]);
  const auto second = client("/?newest");
  second->subscribe(1, second->channel("/kl1/log"));
  for (const auto& line : lines) EXPECT_EQ(second->read_message()->payload, line);
}

// GIVEN a viewer that reads nothing and seven that read WHEN more is sent than fits on its way THEN these seven have every
// message, and the slow one has the newest when it reads at last.
TEST_F(Server, ASlowViewerLosesTheOlderAndSlowsNobody) {
  auto publisher = vehicle_.publish(messages::topics::kFlownMission);
  constexpr std::size_t kItems = 2000;
  const auto mission = [](std::uint64_t id) {
    msg::Mission out;
    out.id(id);
    out.items().resize(kItems);
    return out;
  };
  const auto slow = client();
  std::vector<std::unique_ptr<FoxgloveClient>> others;
  for (int i = 0; i < 7; ++i) others.push_back(client());
  slow->subscribe(1, slow->channel("/kl1/flown_mission"));
  for (const auto& other : others) other->subscribe(1, other->channel("/kl1/flown_mission"));
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1; }));
  const auto id_of = [](const FoxgloveClient::Message& message) {
    msg::Mission out;
    EXPECT_TRUE(dds::from_payload(message.payload.data(), message.payload.size(), out));
    return out.id();
  };
  std::uint64_t id = 0;
  while (server_->totals().dropped == 0) {
    publisher.publish(mission(++id));
    for (const auto& other : others) ASSERT_EQ(id_of(*other->read_message()), id);
    ASSERT_LT(id, 2000U) << "nothing was lost";
  }
  std::uint64_t received = 0;
  std::uint64_t newest = 0;
  while (newest < id) {
    const std::uint64_t next = id_of(*slow->read_message());
    ASSERT_GT(next, newest) << "not in order";
    newest = next;
    ++received;
  }
  EXPECT_LT(received, id);
  EXPECT_EQ(slow->read_text()->at("level"), 1);
}

// A vehicle whose controller refuses everything but a stop.
TEST_F(Server, SendsRequestsAndReturnsTheReasonOfARefusal) {
  auto acks = vehicle_.publish(messages::topics::kCommandAck);
  auto statuses = vehicle_.publish(messages::topics::kControlStatus);
  msg::ControlStatus status;
  status.wire_version(messages::kWireVersion);
  statuses.publish(status);
  tests::Inbox<std::uint8_t> asked;
  const auto commands =
      vehicle_.subscribe<msg::Command>(messages::topics::kCommand, [&](const msg::Command& command) {
        asked.put(command.kind());
        msg::CommandAck ack;
        ack.client(command.client());
        ack.id(command.id());
        ack.accepted(command.kind() == msg::Command_Constants::STOP);
        if (!ack.accepted()) ack.reason("on the ground");
        acks.publish(ack);
      });
  const auto viewer = client();
  viewer->call(viewer->service("/kl1/hold"), {0, 1, 0, 0, 0});
  const auto answer = [&] { return viewer->read_answer(); };
  EXPECT_EQ(answer(), std::make_pair(false, std::string("on the ground")));

  const std::uint32_t stop = viewer->service("/kl1/stop");
  for (const std::vector<std::uint8_t>& unconfirmed :
       {std::vector<std::uint8_t>{0, 1, 0, 0, 0}, {}, {0, 1, 0, 0}}) {
    viewer->call(stop, unconfirmed);
    EXPECT_EQ(viewer->read_text()->at("message"), "stop is not confirmed: data must be true");
  }
  viewer->call(stop, {0, 1, 0, 0, 1});
  EXPECT_EQ(answer(), std::make_pair(true, std::string()));
  std::vector<std::uint8_t> kinds =
      asked.items();  // one is sent again if the controller is discovered meanwhile
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  EXPECT_EQ(kinds, (std::vector<std::uint8_t>{msg::Command_Constants::HOLD, msg::Command_Constants::STOP}));

  viewer->call(200, {});
  EXPECT_EQ(viewer->read_text()->at("message"), "there is no service 200");
}

// GIVEN a vehicle without control WHEN as many landings wait for their answers as may THEN one more is refused, and a stop
// is sent.
TEST_F(Server, SendsAStopBesideManyOtherRequests) {
  tests::Inbox<std::uint8_t> asked;
  const auto commands = vehicle_.subscribe<msg::Command>(
      messages::topics::kCommand, [&](const msg::Command& command) { asked.put(command.kind()); });
  const auto viewer = client();
  const std::uint32_t land = viewer->service("/kl1/land");
  for (std::size_t i = 0; i <= VehicleRequests::kMostUnderWay; ++i) viewer->call(land, {0, 1, 0, 0, 0});
  EXPECT_EQ(viewer->read_text()->at("message"),
            "64 requests to land wait for their answers, which is the most");
  viewer->call(viewer->service("/kl1/stop"), {0, 1, 0, 0, 1});
  EXPECT_TRUE(eventually([&] {
    const std::vector<std::uint8_t> kinds = asked.items();
    return std::find(kinds.begin(), kinds.end(), msg::Command_Constants::STOP) != kinds.end();
  }));
}

}  // namespace swiftlet::ground::view_server_test

// A client of the Foxglove WebSocket protocol.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

namespace swiftlet::tests {

// Blocks until what it reads has come.
class FoxgloveClient {
 public:
  static constexpr const char* kProtocol = "foxglove.websocket.v1";

  struct Message {
    std::uint32_t subscription = 0;
    std::vector<std::uint8_t> payload;
  };

  explicit FoxgloveClient(std::uint16_t port) : socket_(io_) {
    socket_.next_layer().connect({boost::asio::ip::make_address("127.0.0.1"), port});
  }
  // Returns false if it is refused.
  bool open(const std::string& host, const std::string& origin = "", const std::string& target = "/",
            const std::string& protocol = kProtocol) {
    socket_.set_option(
        boost::beast::websocket::stream_base::decorator([&](boost::beast::websocket::request_type& request) {
          if (!origin.empty()) request.set(boost::beast::http::field::origin, origin);
          if (!protocol.empty()) request.set(boost::beast::http::field::sec_websocket_protocol, protocol);
        }));
    boost::system::error_code error;
    boost::beast::websocket::response_type response;
    socket_.handshake(response, host, target, error);
    const auto chosen = response[boost::beast::http::field::sec_websocket_protocol];
    protocol_.assign(chosen.data(), chosen.size());
    return !error;
  }
  const std::string& protocol() const { return protocol_; }

  // nullopt: the server has closed the connection.
  std::optional<nlohmann::json> read_text() {
    while (texts_.empty()) {
      if (!read()) return std::nullopt;
    }
    const nlohmann::json text = texts_.front();
    texts_.pop_front();
    return text;
  }
  std::optional<Message> read_message() {
    while (messages_.empty()) {
      if (!read()) return std::nullopt;
    }
    const Message message = messages_.front();
    messages_.pop_front();
    return message;
  }
  // Reads the answer of a service whose response is bool success, string message.
  std::pair<bool, std::string> read_answer() {
    while (responses_.empty()) {
      if (!read()) return {false, "the server has closed the connection"};
    }
    const std::vector<std::uint8_t> bytes = responses_.front();
    responses_.pop_front();
    constexpr std::size_t kSuccess = 16 + 4;  // behind the heads of the message and of CDR
    constexpr std::size_t kText = kSuccess + 8;
    return {bytes.at(kSuccess) == 1, std::string(bytes.begin() + kText, bytes.end() - 1)};
  }

  bool send(const std::string& text) {
    boost::system::error_code error;
    socket_.text(true);
    socket_.write(boost::asio::buffer(text), error);
    return !error;
  }
  void send(const std::vector<std::uint8_t>& bytes) {
    socket_.binary(true);
    socket_.write(boost::asio::buffer(bytes));
  }

  // Reads what the server says first.
  void greet() {
    for (int i = 0; i < 3; ++i) take_names();
  }
  // Waits until the server knows of the topic, and of the service.
  std::uint32_t channel(const std::string& topic) {
    while (channels_.count(topic) == 0 && take_names()) {
    }
    return channels_.at(topic);
  }
  std::uint32_t service(const std::string& name) {
    while (services_.count(name) == 0 && take_names()) {
    }
    return services_.at(name);
  }
  bool subscribe(std::uint32_t id, std::uint32_t channel) {
    return send(
        nlohmann::json({{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}})
            .dump());
  }
  void call(std::uint32_t service, const std::vector<std::uint8_t>& request) {
    std::vector<std::uint8_t> bytes = {
        2, static_cast<std::uint8_t>(service), 0, 0, 0, 9, 0, 0, 0, 3, 0, 0, 0, 'c', 'd', 'r'};
    bytes.insert(bytes.end(), request.begin(), request.end());
    send(bytes);
  }

 private:
  bool take_names() {
    const std::optional<nlohmann::json> text = read_text();
    if (!text) return false;
    for (const nlohmann::json& channel : text->value("channels", nlohmann::json::array()))
      channels_[channel.at("topic")] = channel.at("id");
    for (const nlohmann::json& service : text->value("services", nlohmann::json::array()))
      services_[service.at("name")] = service.at("id");
    return true;
  }
  bool read() {
    boost::beast::flat_buffer buffer;
    boost::system::error_code error;
    socket_.read(buffer, error);
    if (error) return false;
    const auto* const data = static_cast<const std::uint8_t*>(buffer.data().data());
    if (socket_.got_text()) {
      texts_.push_back(nlohmann::json::parse(data, data + buffer.size()));
    } else if (data[0] == 1) {
      Message message;
      std::memcpy(&message.subscription, data + 1, sizeof(message.subscription));
      message.payload.assign(data + 13, data + buffer.size());
      messages_.push_back(message);
    } else {
      responses_.emplace_back(data, data + buffer.size());
    }
    return true;
  }

  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_;
  std::string protocol_;
  std::deque<nlohmann::json> texts_;
  std::deque<Message> messages_;
  std::deque<std::vector<std::uint8_t>> responses_;
  std::map<std::string, std::uint32_t> channels_;
  std::map<std::string, std::uint32_t> services_;
};

}  // namespace swiftlet::tests

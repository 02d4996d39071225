#include "swiftlet/ground/view/view_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <optional>
#include <set>
#include <stdexcept>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/core.h>

#include "swiftlet/analysis/pages/live_page.hpp"
#include "swiftlet/ground/view/access.hpp"
#include "swiftlet/ground/view/found_vehicles.hpp"
#include "swiftlet/ground/view/live_topics.hpp"
#include "swiftlet/ground/view/vehicle_requests.hpp"
#include "swiftlet/ground/view/viewer.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/token_bucket.hpp"

namespace swiftlet::ground {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using namespace std::chrono_literals;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kRound = 20ms;  // 50 Hz
constexpr auto kLookPeriod = 500ms;
constexpr auto kAcceptPause = 100ms;  // after a connection that could not be accepted
constexpr auto kRequestTime = 10s;    // for a request, and for its answer
constexpr auto kIdleTime = 30s;       // without an answer to a ping
constexpr int kSendBuffer = 256 * 1024;
constexpr double kConnectionBurst = 100.0;
constexpr double kMessageBurst = 1000.0;
constexpr std::size_t kKilobyte = 1024;
constexpr double kKilobyteBurst = 1024.0;

using Request = http::request<http::empty_body>;

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

// The first of our subprotocols that the request offers; "" if it offers none.
std::string subprotocol_of(const Request& request) {
  const std::string offered = text_of(request[http::field::sec_websocket_protocol]);
  for (const char* const known : foxglove::kSubprotocols) {
    for (std::string name : io::split_text(offered, ',')) {
      name.erase(0, name.find_first_not_of(' '));
      name.erase(name.find_last_not_of(' ') + 1);
      if (name == known) return name;
    }
  }
  return "";
}

}  // namespace

std::string fault_of_listen_address(const std::string& address) {
  error_code error;
  asio::ip::make_address(address, error);
  return error ? address + " is no IP address, such as 0.0.0.0 for all interfaces" : "";
}

class ViewServer::Impl {
 public:
  Impl(const Context& context, const ViewSettings& settings, std::function<void(const std::string&)> say);
  ~Impl();

  std::string url() const;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  ViewTotals totals() const;

 private:
  class Visitor;  // a connection until its request is answered
  class Session;  // a connection of a viewer

  void listen(const ViewSettings& settings);
  void run();
  void accept();
  void serve_rounds();
  void look_regularly();
  void add_vehicle(const std::string& name);
  void greet(Viewer& viewer) const;
  void enter(const std::shared_ptr<Session>& session);
  void leave(const std::shared_ptr<Session>& session);

  const Context& context_;
  const ViewSettings settings_;
  const std::function<void(const std::string&)> say_;
  const std::string page_;
  const std::string session_id_ = make_token();
  Access access_;

  runtime::TokenBucket new_connections_{kConnectionBurst, kConnectionsPerSecond};
  std::size_t connections_ = 0;
  asio::io_context io_{1};  // its handlers end the connections that are open at the end
  tcp::acceptor acceptor_{io_};
  asio::steady_timer accept_timer_{io_};
  asio::steady_timer round_timer_{io_};
  asio::steady_timer look_timer_{io_};
  std::atomic<std::size_t> viewers_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> unreceived_{0};
  LiveTopics topics_;
  VehicleRequests requests_;
  FoundVehicles found_;
  std::set<std::shared_ptr<Session>> sessions_;
  std::thread thread_;
};

// Takes the WebSocket over from a Visitor.
class ViewServer::Impl::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Impl& server, beast::tcp_stream stream, Selection selection)
      : server_(server), socket_(std::move(stream)), viewer_(std::in_place, server.topics_, selection) {}
  ~Session() { --server_.connections_; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start(const Request& request, const std::string& subprotocol) {
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.handshake_timeout = kRequestTime;
    timeout.idle_timeout = kIdleTime;
    timeout.keep_alive_pings = true;
    socket_.set_option(timeout);
    socket_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    socket_.read_message_max(kMostMessageBytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return self->end();
      self->is_open_ = true;
      self->server_.greet(*self->viewer_);
      self->server_.enter(self);
      self->pump();
      self->read();
    });
  }

  Viewer& viewer() { return *viewer_; }

  // Sends what waits, in as few packets as hold it.
  void pump() {
    if (!is_open_) return;
    if (viewer_->is_stuck()) return close("the answers to its messages are not read");
    if (is_writing_) return;
    sending_ = viewer_->next();
    fill_packets(sending_.has_value());
    if (!sending_) return;
    is_writing_ = true;
    socket_.text(sending_->is_text);
    std::array<asio::const_buffer, 2> buffers = {asio::buffer(sending_->head)};
    if (sending_->payload) buffers[1] = asio::buffer(*sending_->payload);
    socket_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
      self->is_writing_ = false;
      if (error) return self->end();
      self->pump();
    });
  }

  // Says it to the viewer once it has lost more.
  void count_dropped() {
    if (!viewer_) return;
    const std::uint64_t lost = viewer_->dropped() - dropped_;
    if (lost == 0) return;
    server_.dropped_ += lost;
    dropped_ = viewer_->dropped();
    viewer_->reply(foxglove::status(foxglove::Level::kWarning,
                                    fmt::format("this viewer is slow: it has lost {} messages", dropped_)));
    pump();
  }

  // What remains of the session uses the topics no more.
  void detach() { viewer_.reset(); }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error || !self->is_open_) return self->end();
      if (!self->may_send_more()) return;
      self->take_message();
      self->pump();
      if (self->is_open_) self->read();
    });
  }

  // Disconnects a viewer that may not.
  bool may_send_more() {
    const std::int64_t now_ns = runtime::monotonic_ns();
    bool may = messages_.take(now_ns);
    if (!may) close("it sends too many messages");
    for (std::size_t begun = 0; may && begun < buffer_.size(); begun += kKilobyte) {
      may = kilobytes_.take(now_ns);
      if (!may) close("it sends too much");
    }
    return may;
  }

  void take_message() {
    const auto data = beast::buffers_front(buffer_.cdata());
    foxglove::ClientMessage message;
    if (socket_.got_text()) {
      message = foxglove::parse_text({static_cast<const char*>(data.data()), data.size()});
    } else {
      message = foxglove::parse_binary(static_cast<const std::uint8_t*>(data.data()), data.size());
    }
    buffer_.consume(buffer_.size());
    std::visit([this](const auto& one) { take(one); }, message);
  }
  void take(const foxglove::Subscribe& message) { viewer_->take(message); }
  void take(const foxglove::Unsubscribe& message) { viewer_->take(message); }
  void take(const foxglove::Fault& fault) {
    viewer_->reply(foxglove::status(foxglove::Level::kError, fault.message));
  }
  void take(const foxglove::ServiceCall& call) {
    const auto done = [weak = weak_from_this(), &io = server_.io_, service = call.service,
                       id = call.call](const VehicleRequests::Answer& answer) {
      asio::post(io, [weak, service, id, response = to_response(answer)] {
        const auto self = weak.lock();
        if (!self || !self->viewer_) return;
        self->viewer_->reply(foxglove::service_response(service, id, response));
        self->pump();
      });
    };
    const std::string refusal = server_.requests_.call(call, done);
    if (!refusal.empty()) viewer_->reply(foxglove::service_failure(call.service, call.call, refusal));
  }

  // Whether a packet waits until it is full (TCP_CORK).
  void fill_packets(bool wanted) {
    if (std::exchange(fills_packets_, wanted) == wanted) return;
    const int cork = wanted ? 1 : 0;
    ::setsockopt(beast::get_lowest_layer(socket_).socket().native_handle(), IPPROTO_TCP, TCP_CORK, &cork,
                 sizeof(cork));
  }

  void close(const std::string& why) {
    if (!std::exchange(is_open_, false)) return;
    ++server_.refused_;
    server_.say_("a viewer is disconnected: " + why);
    // A close frame would wait for the messages before it.
    end();
  }

  void end() {
    is_open_ = false;
    detach();
    beast::get_lowest_layer(socket_).close();
    server_.leave(shared_from_this());
  }

  Impl& server_;
  websocket::stream<beast::tcp_stream, false> socket_;
  beast::flat_buffer buffer_{kMostMessageBytes};
  runtime::TokenBucket messages_{kMessageBurst, kMessagesPerSecond};
  runtime::TokenBucket kilobytes_{kKilobyteBurst, kKilobytesPerSecond};
  std::optional<Viewer> viewer_;
  std::optional<Outgoing> sending_;
  bool is_open_ = false;
  bool is_writing_ = false;
  bool fills_packets_ = false;
  std::uint64_t dropped_ = 0;
};

class ViewServer::Impl::Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(Impl& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.connections_;
    parser_.header_limit(kMostRequestBytes);
  }
  ~Visitor() {
    if (!passed_on_) --server_.connections_;
  }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  void start() {
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error == http::error::header_limit)
        return self->refuse(http::status::request_header_fields_too_large, "the request is too large");
      if (error.category() == http::make_error_code(http::error::bad_method).category() &&
          error != http::error::end_of_stream)
        return self->refuse(http::status::bad_request, "the request is not understood: " + error.message());
      if (!error) self->answer();
    });
  }

 private:
  void answer() {
    const Request& request = parser_.get();
    const std::string target = text_of(request.target());
    const auto refusal =
        refusal_of({target, text_of(request[http::field::host]), text_of(request[http::field::origin])},
                   server_.access_);
    if (refusal) return refuse(http::status::forbidden, *refusal);
    if (path_of(target) != "/") return refuse(http::status::not_found, "there is only the page /");
    if (websocket::is_upgrade(request)) return upgrade(has_query(target, "newest"));
    if (request.method() != http::verb::get)
      return refuse(http::status::method_not_allowed, "only GET is served");
    send(http::status::ok, "text/html; charset=utf-8", server_.page_);
  }

  void upgrade(bool newest) {
    const std::string subprotocol = subprotocol_of(parser_.get());
    if (subprotocol.empty())
      return refuse(http::status::bad_request,
                    fmt::format("the WebSocket must offer the subprotocol {} or {}",
                                foxglove::kSubprotocols[0], foxglove::kSubprotocols[1]));
    stream_.expires_never();
    passed_on_ = true;
    std::make_shared<Session>(server_, std::move(stream_), newest ? Selection::kNewest : Selection::kAll)
        ->start(parser_.get(), subprotocol);
  }

  void refuse(http::status status, const std::string& why) {
    ++server_.refused_;
    send(status, "text/plain; charset=utf-8", why + "\n");
  }

  void send(http::status status, const char* type, const std::string& body) {
    response_.result(status);
    response_.version(11);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy",
                  "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; "
                  "connect-src 'self' ws:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.keep_alive(false);
    response_.body() = body;
    response_.prepare_payload();
    stream_.expires_after(kRequestTime);
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Impl& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kMostRequestBytes};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
  bool passed_on_ = false;
};

ViewServer::Impl::Impl(const Context& context, const ViewSettings& settings,
                       std::function<void(const std::string&)> say)
    : context_(context),
      settings_(settings),
      say_(std::move(say)),
      page_(pages::live_page()),
      topics_(context),
      requests_(context),
      found_({[this](const std::string& name) { requests_.add_vehicle(name); },
              [this](const std::string& name) { topics_.add_vehicle(name); }},
             say_) {
  listen(settings);
  for (const std::string& name : settings_.vehicles) add_vehicle(name);
  accept();
  look_regularly();
  serve_rounds();
  thread_ = std::thread([this] { run(); });
}

ViewServer::Impl::~Impl() {
  io_.stop();
  thread_.join();
  for (const auto& session : sessions_) session->detach();
}

void ViewServer::Impl::listen(const ViewSettings& settings) {
  const tcp::endpoint endpoint(asio::ip::make_address(settings.address), settings.port);
  access_.origins = settings.origins;
  if (!endpoint.address().is_loopback()) access_.token = make_token();
  try {
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.set_option(asio::socket_base::send_buffer_size(kSendBuffer));
    acceptor_.bind(endpoint);
    acceptor_.listen();
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(fmt::format("{} port {} cannot be used: {}", settings.address, settings.port,
                                         error.code().message()));
  }
}

std::string ViewServer::Impl::url() const {
  const tcp::endpoint endpoint = acceptor_.local_endpoint();
  std::string host = endpoint.address().to_string();
  if (endpoint.address().is_unspecified()) {
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    host = name.data();
  } else if (endpoint.address().is_v6()) {
    host = "[" + host + "]";
  }
  const std::string query = access_.token.empty() ? "" : "?token=" + access_.token;
  return fmt::format("http://{}:{}/{}", host, endpoint.port(), query);
}

ViewTotals ViewServer::Impl::totals() const { return {viewers_, refused_, dropped_, unreceived_}; }

// What fails in one round, such as the topics of a vehicle, is said, and the others go on.
void ViewServer::Impl::run() {
  while (!io_.stopped()) {
    try {
      io_.run();
    } catch (const std::exception& error) {
      say_(error.what());
    }
  }
}

void ViewServer::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error) {  // such as too many open files
      accept_timer_.expires_after(kAcceptPause);
      return accept_timer_.async_wait([this](error_code) { accept(); });
    }
    const bool is_welcome = connections_ < kMostConnections && new_connections_.take(runtime::monotonic_ns());
    if (is_welcome) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<Visitor>(*this, std::move(socket))->start();
    } else {
      ++refused_;
    }
    accept();
  });
}

void ViewServer::Impl::serve_rounds() {
  round_timer_.expires_after(kRound);
  round_timer_.async_wait([this](error_code) {
    serve_rounds();
    for (const auto& session : sessions_) session->viewer().begin_round();
    topics_.take_all([this](std::uint32_t channel, const LiveTopics::Live& live) {
      for (const auto& session : sessions_) session->viewer().put(channel, live);
    });
    const auto sessions = sessions_;  // one that fails leaves
    for (const auto& session : sessions) session->pump();
  });
}

void ViewServer::Impl::look_regularly() {
  look_timer_.expires_after(kLookPeriod);
  look_timer_.async_wait([this](error_code) {
    look_regularly();
    unreceived_ = topics_.dropped();
    const auto sessions = sessions_;
    for (const auto& session : sessions) session->count_dropped();
    const std::vector<std::string> names =
        settings_.vehicles.empty() ? context_.discovered_vehicles() : settings_.vehicles;
    for (const std::string& name : names) add_vehicle(name);
  });
}

void ViewServer::Impl::add_vehicle(const std::string& name) {
  const std::size_t channels = topics_.channels().size();
  const std::size_t services = requests_.services().size();
  if (!found_.add(name)) return;
  if (topics_.channels().size() == channels && requests_.services().size() == services) return;
  const std::string new_channels = foxglove::advertise(
      std::vector<foxglove::Channel>(topics_.channels().begin() + channels, topics_.channels().end()));
  const std::string new_services = foxglove::advertise(
      std::vector<foxglove::Service>(requests_.services().begin() + services, requests_.services().end()));
  const auto sessions = sessions_;
  for (const auto& session : sessions) {
    session->viewer().reply(new_channels);
    session->viewer().reply(new_services);
    session->pump();
  }
}

void ViewServer::Impl::greet(Viewer& viewer) const {
  viewer.reply(foxglove::server_info(settings_.program, session_id_));
  viewer.reply(foxglove::advertise(topics_.channels()));
  viewer.reply(foxglove::advertise(requests_.services()));
}

void ViewServer::Impl::enter(const std::shared_ptr<Session>& session) {
  sessions_.insert(session);
  viewers_ = sessions_.size();
}

void ViewServer::Impl::leave(const std::shared_ptr<Session>& session) {
  sessions_.erase(session);
  viewers_ = sessions_.size();
}

ViewServer::ViewServer(const Context& context, const ViewSettings& settings,
                       std::function<void(const std::string&)> say)
    : impl_(std::make_unique<Impl>(context, settings, std::move(say))) {}
ViewServer::~ViewServer() = default;
std::string ViewServer::url() const { return impl_->url(); }
std::uint16_t ViewServer::port() const { return impl_->port(); }
ViewTotals ViewServer::totals() const { return impl_->totals(); }

}  // namespace swiftlet::ground

// Serves the live page of running vehicles, and their topics by the Foxglove WebSocket protocol, on one port.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/ground/client/context.hpp"

namespace swiftlet::ground {

struct ViewSettings {
  static constexpr std::uint16_t kDefaultPort = 8765;  // that of Foxglove

  std::string address = "127.0.0.1";  // to listen at; others than that of the loopback interface need a token
  std::uint16_t port = kDefaultPort;  // 0: any that is free
  std::vector<std::string> vehicles;  // empty: all of the domain, also those that appear later
  std::vector<std::string> origins;   // of pages of others that may connect
  std::string program = "swiftlet";   // with its version
};

// What is wrong with an address to listen at, a sentence; "" if nothing is.
std::string fault_of_listen_address(const std::string& address);

struct ViewTotals {
  std::size_t viewers = 0;       // connected now
  std::uint64_t refused = 0;     // requests and connections
  std::uint64_t dropped = 0;     // messages that viewers lost because they were slow
  std::uint64_t unreceived = 0;  // messages that all viewers lost because the computer was busy
};

// One thread serves all viewers; it waits for none of them. A viewer that connects with "?newest" in its URL, as the
// live page does, gets the newest message of each topic 50 times a second; others get each message.
class ViewServer {
 public:
  static constexpr std::size_t kMostConnections = 32;      // more are closed at once
  static constexpr std::size_t kMostRequestBytes = 8192;   // of an HTTP request
  static constexpr std::size_t kMostMessageBytes = 65536;  // of a message of a viewer
  static constexpr double kConnectionsPerSecond = 20.0;    // and a burst of 100
  static constexpr double kMessagesPerSecond = 100.0;      // of a viewer, and a burst of 1000
  static constexpr double kKilobytesPerSecond = 64.0;      // of a viewer, of 1024 bytes, and a burst of 1024

  // context must outlive it. say: receives sentences about what fails meanwhile, in the thread of the server. Throws
  // std::runtime_error if the port cannot be used, or the vehicles' topics cannot.
  ViewServer(const Context& context, const ViewSettings& settings,
             std::function<void(const std::string&)> say);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  std::string url() const;  // of the page, with the token if one is needed
  std::uint16_t port() const;
  ViewTotals totals() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::ground

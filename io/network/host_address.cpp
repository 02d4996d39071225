#include "swiftlet/io/network/host_address.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cctype>
#include <charconv>
#include <memory>
#include <netdb.h>
#include <netinet/in.h>
#include <stdexcept>

#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

bool is_host(const std::string& text) {
  const bool has_name_characters = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_';
  });
  if (text.empty() || !has_name_characters) return false;
  // A text of only digits and dots must be a complete address.
  in_addr address{};
  return text.find_first_not_of("0123456789.") != std::string::npos ||
         ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

// 0 if it is not a port.
std::uint16_t port_of(const std::string& text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, port);
  return error == std::errc() && stop == end ? port : 0;
}

}  // namespace

std::string to_string(Ipv4 address) {
  const in_addr bytes{htonl(address)};
  char text[INET_ADDRSTRLEN] = {};
  return ::inet_ntop(AF_INET, &bytes, text, sizeof text);
}

std::string fault_of_host_address(const std::string& text) {
  const std::size_t colon = text.find(':');
  const bool has_port = colon != std::string::npos;
  if (is_host(text.substr(0, colon)) && (!has_port || port_of(text.substr(colon + 1)) != 0)) return "";
  return "is '" + text + "', must be HOST or HOST:PORT, a name or IPv4 address and a port from 1 to 65535";
}

HostAddress parse_host_address(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, 0};
  return {text.substr(0, colon), port_of(text.substr(colon + 1))};
}

std::vector<std::string> ipv4_addresses_of(const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* first = nullptr;
  const int fault = ::getaddrinfo(host.c_str(), nullptr, &wanted, &first);
  if (fault != 0) throw std::runtime_error("host '" + host + "' is unknown: " + ::gai_strerror(fault));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(first, ::freeaddrinfo);
  std::vector<std::string> addresses;
  for (const addrinfo* it = first; it != nullptr; it = it->ai_next) {
    addresses.push_back(to_string(ntohl(reinterpret_cast<const sockaddr_in*>(it->ai_addr)->sin_addr.s_addr)));
  }
  return addresses;
}

std::string fault_of_discovery_servers(const std::string& list) {
  const std::vector<std::string> parts = split_text(list, ';');
  const bool valid = std::all_of(parts.begin(), parts.end(), [](const std::string& part) {
    return part.empty() || fault_of_host_address(part).empty();
  });
  const bool has_one =
      std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return !part.empty(); });
  if (valid && has_one && parts.size() <= kMaxDiscoveryServers) return "";
  return "is '" + list +
         "', must be HOST or HOST:PORT, a name or IPv4 address and a port from 1 to 65535; several, "
         "separated "
         "by ';', are the servers 0, 1, ...";
}

std::vector<DiscoveryServerAddress> parse_discovery_servers(const std::string& list) {
  std::vector<DiscoveryServerAddress> servers;
  const std::vector<std::string> parts = split_text(list, ';');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    HostAddress address = parse_host_address(parts[i]);
    if (address.port == 0) address.port = kDiscoveryServerPort;
    servers.push_back({static_cast<int>(i), address});
  }
  return servers;
}

}  // namespace swiftlet::io

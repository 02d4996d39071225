#include "swiftlet/services/dds/discovery/host_address.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cctype>
#include <charconv>
#include <memory>
#include <netdb.h>
#include <netinet/in.h>
#include <stdexcept>

namespace swiftlet::comms {
namespace {

bool is_host(const std::string& text) {
  const bool has_name_characters = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_';
  });
  if (text.empty() || !has_name_characters) return false;
  // Of digits and dots only: an address, complete.
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
    char text[INET_ADDRSTRLEN] = {};
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(it->ai_addr)->sin_addr, text, sizeof text);
    addresses.emplace_back(text);
  }
  return addresses;
}

}  // namespace swiftlet::comms

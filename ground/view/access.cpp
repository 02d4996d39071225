#include "swiftlet/ground/view/access.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <sys/random.h>

#include <fmt/format.h>

#include "swiftlet/io/text.hpp"

namespace swiftlet::ground {
namespace {

// "localhost", "127.0.0.1" or "[::1]", with a port or without.
bool is_loopback(const std::string& host) {
  const std::size_t colon = host.find(':', host.front() == '[' ? host.find(']') : 0);
  const std::string name = host.substr(0, colon);
  const bool is_number = name.find_first_not_of("0123456789.") == std::string::npos;
  return name == "localhost" || name == "[::1]" || (is_number && name.compare(0, 4, "127.") == 0);
}

// Takes the same time wherever they differ.
bool same(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

// The parts of the query, "name=value" or "name".
std::vector<std::string> parts_of(const std::string& target) {
  const std::size_t mark = target.find('?');
  if (mark == std::string::npos) return {};
  return io::split_text(target.substr(mark + 1), '&');
}

}  // namespace

std::optional<std::string> refusal_of(const Visit& visit, const Access& access) {
  if (visit.host.empty()) return "the request names no host";
  if (access.token.empty() && !is_loopback(visit.host))
    return "only localhost is served: open http://localhost with the port of this server";
  if (!access.token.empty() && !same(query_value(visit.target, "token"), access.token))
    return "the token is missing or wrong: open the URL that `swiftlet view` prints";
  const bool is_own = visit.origin.empty() || visit.origin == "http://" + visit.host;
  if (!is_own &&
      std::find(access.origins.begin(), access.origins.end(), visit.origin) == access.origins.end())
    return "pages of " + visit.origin + " may not connect; `swiftlet view --allow-origin` lets them";
  return std::nullopt;
}

std::string make_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system gives no random numbers for the token");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

std::string path_of(const std::string& target) { return target.substr(0, target.find('?')); }

std::string query_value(const std::string& target, const std::string& name) {
  for (const std::string& part : parts_of(target)) {
    if (part.compare(0, name.size() + 1, name + "=") == 0) return part.substr(name.size() + 1);
  }
  return "";
}

bool has_query(const std::string& target, const std::string& name) {
  for (const std::string& part : parts_of(target)) {
    if (part == name || part.compare(0, name.size() + 1, name + "=") == 0) return true;
  }
  return false;
}

}  // namespace swiftlet::ground

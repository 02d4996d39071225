// Who may open the live page and connect to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swiftlet::ground {

struct Access {
  std::string token;  // in the URL of each request; empty: only by names of the loopback interface
  std::vector<std::string> origins;  // of pages of others that may connect: "https://app.foxglove.dev"
};

// What a request says of itself.
struct Visit {
  std::string target;  // "/?token=..."
  std::string host;    // "localhost:8765"
  std::string origin;  // of the page that sends it; empty: a program sends it, not a page
};

// Returns why a request is refused, a sentence; nullopt if it may pass. A page of others, also one that a name server
// leads to this host, has an origin or a host of its own: a browser never gives it access.
std::optional<std::string> refusal_of(const Visit& visit, const Access& access);

// 128 random bits as hexadecimal digits. Throws std::runtime_error if the system has none.
std::string make_token();

// "/live?token=1" has the path "/live" and the value "1" of "token"; "" if a target has no such value.
std::string path_of(const std::string& target);
std::string query_value(const std::string& target, const std::string& name);
bool has_query(const std::string& target, const std::string& name);  // also without a value

}  // namespace swiftlet::ground

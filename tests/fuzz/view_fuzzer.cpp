// Fuzzes what the server of the live view reads: messages of the Foxglove protocol, and who asks for access. The first byte
// of the input chooses: a text, a binary message, or the lines target, host, origin and token.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/view/access.hpp"
#include "swiftlet/ground/view/foxglove.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

namespace {

using tests::demand;

constexpr const char* kAllowed = "https://app.foxglove.dev";

bool begins_with(const std::string& text, std::string_view begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

// The server sends the sentence of a fault back.
void check(const ground::foxglove::ClientMessage& message) {
  const auto* const fault = std::get_if<ground::foxglove::Fault>(&message);
  if (fault == nullptr) return;
  const std::string answer = ground::foxglove::status(ground::foxglove::Level::kError, fault->message);
  demand(!fault->message.empty(), "a fault has a sentence");
  demand(nlohmann::json::accept(answer), "the answer to a fault is JSON");
}

void check_text(std::string_view text) {
  const ground::foxglove::ClientMessage message = ground::foxglove::parse_text(text);
  check(message);
  demand(!std::holds_alternative<ground::foxglove::ServiceCall>(message), "a text is no service call");
}

void check_binary(const std::uint8_t* data, std::size_t size) {
  const ground::foxglove::ClientMessage message = ground::foxglove::parse_binary(data, size);
  check(message);
  const auto* const call = std::get_if<ground::foxglove::ServiceCall>(&message);
  if (call == nullptr)
    return demand(std::holds_alternative<ground::foxglove::Fault>(message), "it is refused");
  demand(call->encoding.size() + call->request.size() + 13 == size, "each byte is read once");
}

void check_access(std::string_view text) {
  std::array<std::string, 4> lines;
  for (std::string& line : lines) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const auto& [target, host, origin, token] = lines;
  const auto refusal = ground::refusal_of({target, host, origin}, {token, {kAllowed}});
  demand(begins_with(target, ground::path_of(target)), "the path is the begin of the target");
  demand(ground::has_query(target, "token") || ground::query_value(target, "token").empty(),
         "what has a value is there");
  if (refusal) return demand(!refusal->empty(), "a refusal has a sentence");
  demand(origin.empty() || origin == kAllowed || origin == "http://" + host, "a page of others is refused");
  if (!token.empty())
    return demand(target.find("token=" + token) != std::string::npos, "the token is in the target");
  demand(begins_with(host, "localhost") || begins_with(host, "[::1]") || begins_with(host, "127."),
         "without a token, only this host is served");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view rest = tests::text_of(data + 1, size - 1);
  switch (data[0]) {
    case 't':
      check_text(rest);
      break;
    case 'b':
      check_binary(data + 1, size - 1);
      break;
    default:
      check_access(rest);
  }
  return 0;
}

#include "swiftlet/services/dds/datagram/refusal_log.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <string>

#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::comms {
namespace {

// Of a locator: an IPv4 address is in the last four bytes.
std::string text_of(const SenderAddress& address) {
  const bool is_ipv4 =
      std::all_of(address.begin(), address.begin() + 12, [](std::uint8_t byte) { return byte == 0; });
  char text[INET6_ADDRSTRLEN] = {};
  ::inet_ntop(is_ipv4 ? AF_INET : AF_INET6, is_ipv4 ? address.data() + 12 : address.data(), text,
              sizeof text);
  return text;
}

}  // namespace

void RefusalLog::note(const SenderAddress& address, const char* rule) {
  ++total_;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock) return;
  const auto others = senders_.end() - 1;
  auto sender = std::find_if(senders_.begin(), others, [&](const Sender& known) {
    return known.last_rule != nullptr && known.address == address;
  });
  if (sender == others)
    sender = std::find_if(senders_.begin(), others,
                          [](const Sender& known) { return known.last_rule == nullptr; });
  if (sender != others) sender->address = address;
  sender->last_rule = rule;
  ++sender->refused;
}

void RefusalLog::write_due(std::chrono::steady_clock::time_point now) {
  std::array<Sender, kSenders> due{};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < kSenders; ++i) {
      if (now < senders_[i].next_line) continue;
      due[i] = senders_[i];
      if (due[i].refused == 0) {
        senders_[i] = Sender();
        continue;
      }
      senders_[i].refused = 0;
      senders_[i].next_line = now + kRefusalLogPeriod;
    }
  }
  for (std::size_t i = 0; i < kSenders; ++i) {
    const Sender& sender = due[i];
    if (sender.refused == 0) continue;
    runtime::log_warning("refused {} datagram{} from {}; the last: {}", sender.refused,
                         sender.refused == 1 ? "" : "s",
                         i + 1 < kSenders ? text_of(sender.address) : "other senders", sender.last_rule);
  }
}

}  // namespace swiftlet::comms

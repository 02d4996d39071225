#include "swiftlet/services/rtps/refusal_log.hpp"

#include <algorithm>

#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::rtps {

void RefusalLog::note(io::Ipv4 address, const char* rule) {
  ++total_;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock) return;
  auto sender = std::find_if(senders_.begin(), senders_.end(),
                             [=](const Sender& known) { return known.address == address; });
  if (sender == senders_.end()) {
    if (senders_.size() < kSenders) senders_.push_back({senders_.size() + 1 < kSenders ? address : 0});
    sender = senders_.end() - 1;
  }
  sender->last_rule = rule;
  ++sender->refused;
}

void RefusalLog::write_due(std::chrono::steady_clock::time_point now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto sender = senders_.begin(); sender != senders_.end();) {
    if (now >= sender->next_line && sender->refused == 0) {
      sender = senders_.erase(sender);
      continue;
    }
    if (now >= sender->next_line) {
      runtime::log_warning(
          "refused {} datagram{} from {}; the last: {}", sender->refused, sender->refused == 1 ? "" : "s",
          sender->address == 0 ? "other senders" : io::to_string(sender->address), sender->last_rule);
      sender->refused = 0;
      sender->next_line = now + kRefusalLogPeriod;
    }
    ++sender;
  }
}

std::vector<RefusalLog::Refusal> RefusalLog::last() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Refusal> refusals;
  for (const Sender& sender : senders_) refusals.push_back({sender.address, sender.last_rule});
  return refusals;
}

}  // namespace swiftlet::rtps

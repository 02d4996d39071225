#include "swiftlet/services/dds/security/refused_peers.hpp"

#include <iterator>
#include <sstream>
#include <utility>

#include <fastdds/dds/log/Log.hpp>

#include "swiftlet/services/dds/fast_dds_library.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::comms {
namespace {

// Categories of messages in the log of Fast DDS: its own, and that of note().
constexpr const char* kReason = "SECURITY_AUTHENTICATION";
constexpr const char* kRefusal = "SWIFTLET_REFUSAL";
constexpr std::size_t kMostReasons = 64;

// Fast DDS logs the reason of a refusal without a GUID, and then reports the refusal in the same thread, in which note() logs
// the GUID. So each reason stands directly before its GUID in the log.
struct Reasons {
  std::mutex mutex;
  std::string last;  // its GUID follows
  std::map<std::string, std::string> by_guid;
};

// Lives as long as the log of Fast DDS, which is until the end of the process.
Reasons& reasons() {
  static auto* const all = new Reasons;
  return *all;
}

void take_warning(const std::string& category, const std::string& message) {
  Reasons& known = reasons();
  const std::lock_guard<std::mutex> lock(known.mutex);
  if (category == kReason) known.last = message;
  if (category != kRefusal || known.last.empty()) return;
  if (known.by_guid.size() >= kMostReasons) known.by_guid.clear();
  known.by_guid[message] = std::exchange(known.last, {});
}

// ": its certificate has expired", of "Invalidation error of certificate  (certificate has expired)".
std::string in_words(const std::string& reason) {
  const std::size_t open = reason.find('(');
  const std::size_t close = reason.rfind(')');
  if (reason.rfind("Invalidation error of certificate", 0) != 0 || open == std::string::npos ||
      close == std::string::npos)
    return ": " + reason;
  const std::string why = reason.substr(open + 1, close - open - 1);
  return (why.rfind("certificate", 0) == 0 ? ": its " : ": ") + why;
}

// Empty if Fast DDS gave none.
std::string logged_reason(const RefusedPeers::Guid& guid) {
  std::ostringstream text;
  text << guid;
  Reasons& known = reasons();
  const std::lock_guard<std::mutex> lock(known.mutex);
  const auto found = known.by_guid.find(text.str());
  return found == known.by_guid.end() ? "" : in_words(found->second);
}

}  // namespace

RefusedPeers::RefusedPeers() { hear_fast_dds_warnings(&take_warning); }

RefusedPeers::~RefusedPeers() = default;

void RefusedPeers::note(const Guid& guid, const std::string& peer, const char* reason, Time now) {
  if (*reason == '\0') EPROSIMA_LOG_WARNING(SWIFTLET_REFUSAL, guid);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (written_.count(guid) > 0 || due_.size() + written_.size() >= kMostLines) return;
  due_.emplace(guid, Refusal{peer, reason, now});
}

void RefusedPeers::write_due(Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto it = written_.begin(); it != written_.end();)
    it = now - it->second > kRepeatTime ? written_.erase(it) : std::next(it);
  for (auto it = due_.begin(); it != due_.end();) {
    const auto& [guid, refusal] = *it;
    if (now - kReasonTime < refusal.at) {
      ++it;
      continue;
    }
    const std::string logged = logged_reason(guid);
    runtime::log_warning("refused {}{}", refusal.peer, logged.empty() ? refusal.reason : logged);
    written_[guid] = now;
    it = due_.erase(it);
  }
}

}  // namespace swiftlet::comms

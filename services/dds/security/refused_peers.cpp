#include "swiftlet/services/dds/security/refused_peers.hpp"

#include <iterator>
#include <memory>

#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <spdlog/spdlog.h>

#include "swiftlet/services/dds/fast_dds_library.hpp"

namespace swiftlet::comms {
namespace {

namespace dds = eprosima::fastdds::dds;

constexpr const char* kAuthentication = "SECURITY_AUTHENTICATION";

// The last one that Fast DDS gave.
struct Reason {
  std::mutex mutex;
  std::string text;
  RefusedPeers::Time at;
};

// Lives as long as the log of Fast DDS, which is until the end of the process.
Reason& last_reason() {
  static auto* const reason = new Reason;
  return *reason;
}

// Keeps the reasons of refusals, which are warnings, and writes errors to standard error.
class ReasonConsumer final : public dds::StdoutErrConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    if (entry.context.category == nullptr || entry.context.category != std::string(kAuthentication)) {
      if (entry.kind == dds::Log::Kind::Error) StdoutErrConsumer::Consume(entry);
      return;
    }
    Reason& reason = last_reason();
    const std::lock_guard<std::mutex> lock(reason.mutex);
    reason.text = entry.message;
    reason.at = std::chrono::steady_clock::now();
  }
};

// "; certificate has expired", or empty if Fast DDS gave none since then.
std::string reason_since(RefusedPeers::Time since) {
  Reason& reason = last_reason();
  const std::lock_guard<std::mutex> lock(reason.mutex);
  if (reason.text.empty() || reason.at < since) return {};
  const std::size_t open = reason.text.find('(');
  const std::size_t close = reason.text.find(')', open);
  if (open == std::string::npos || close == std::string::npos) return ": " + reason.text;
  return ": its " + reason.text.substr(open + 1, close - open - 1);
}

}  // namespace

RefusedPeers::RefusedPeers() {
  set_up_fast_dds();
  static const bool done = [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<ReasonConsumer>());
    dds::Log::SetVerbosity(dds::Log::Kind::Warning);
    return true;
  }();
  static_cast<void>(done);
}

RefusedPeers::~RefusedPeers() = default;

void RefusedPeers::note(const Guid& guid, const std::string& peer, const char* reason, Time now) {
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
    const std::string known = reason_since(refusal.at - kReasonTime);
    spdlog::warn("refused {}{}", refusal.peer, known.empty() ? refusal.reason : known);
    written_[guid] = now;
    it = due_.erase(it);
  }
}

}  // namespace swiftlet::comms

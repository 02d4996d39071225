#include "swiftlet/services/dds/discovery/announcement_budget.hpp"

#include <algorithm>

namespace swiftlet::comms {
namespace {

constexpr double kUsualRate = 10.0;  // 1/s, of vehicle and motion capture
// Twelve processes get all copies of what tells of endpoints, and a loss costs a larger domain a second at most.
constexpr std::size_t kManyProcesses = 12;
constexpr int kFewEndpointCopies = 2;

double share(std::size_t processes) {
  return std::max(kHeardAnnouncements / static_cast<double>(std::max<std::size_t>(processes, 1)),
                  kLeastAnnouncements);
}

}  // namespace

int AnnouncementBudget::copies(std::uint64_t digest, std::size_t processes, std::int64_t now_ns) {
  const double rate = share(processes);
  tokens_.set_rate(rate);
  const bool has_token = tokens_.take(now_ns);
  if (digest != last_digest_) {
    last_digest_ = digest;
    return kAnnouncementCopies;
  }
  if (!has_token) return 0;
  return std::clamp(static_cast<int>(rate / kUsualRate), 1, kAnnouncementCopies);
}

int endpoint_copies(std::size_t processes) {
  return processes <= kManyProcesses ? kEndpointCopies : kFewEndpointCopies;
}

}  // namespace swiftlet::comms

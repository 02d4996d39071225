#include "swiftlet/services/dds/discovery/announcement_budget.hpp"

#include <algorithm>

namespace swiftlet::dds {
namespace {

constexpr double kUsualRate = 10.0;  // 1/s, of vehicle and motion capture
// Twelve processes get all copies of what tells of endpoints, and a loss costs a larger domain a second at most.
constexpr std::size_t kManyProcesses = 12;
constexpr int kFewEndpointCopies = 2;
// A tool that joins more than that hears all of them at once, more than its sockets hold.
constexpr std::size_t kCrowd = 40;

double rate_of(std::size_t processes, bool is_known) {
  const double count = static_cast<double>(std::max<std::size_t>(processes, 1));
  if (is_known) return std::max(kHeardAnnouncements / count, kLeastAnnouncements);
  if (processes <= kManyProcesses) return kHeardAnnouncements / count;
  return std::min(kHeardByAnyone, kHeardByAll / count) / count;
}

}  // namespace

int AnnouncementBudget::copies(std::uint64_t digest, std::size_t processes, std::int64_t joined_ns,
                               std::int64_t now_ns) {
  const bool is_known = joined_ns != 0;
  const double rate = rate_of(processes, is_known);
  tokens_.set(std::clamp(rate, 1.0, kBurst), rate);
  const bool has_token = tokens_.take(now_ns);
  const bool is_first = last_ns_ == 0 || joined_ns > last_ns_;
  const bool is_news = digest != last_digest_;
  if (!has_token && !is_first && !is_news) return 0;
  last_digest_ = digest;
  last_ns_ = now_ns;
  if (is_first && !is_known) return 1;  // nobody knows yet how many there are
  if (is_news && !is_first && is_known) return kAnnouncementCopies;
  return std::clamp(static_cast<int>(rate / kUsualRate), 1, kAnnouncementCopies);
}

int endpoint_copies(std::size_t processes) {
  if (processes > kCrowd) return 1;
  return processes <= kManyProcesses ? kEndpointCopies : kFewEndpointCopies;
}

}  // namespace swiftlet::dds

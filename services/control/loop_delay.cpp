#include "swiftlet/services/control/loop_delay.hpp"

namespace swiftlet::services {

void LoopDelay::sample(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed) {
  const bool restarted = stamp_ns < last_stamp_ns_;
  if (!started_ || restarted) *this = {};
  if (!started_) {
    window_end_ns_ = stamp_ns + kFirstWindowNs;
    last_obeyed_ns_ = obeyed.any ? obeyed.stamp_ns : -1;  // may have been obeyed long before
  }
  started_ = true;
  last_stamp_ns_ = stamp_ns;
  if (obeyed.any && obeyed.stamp_ns != last_obeyed_ns_) {
    ages_.record(stamp_ns - obeyed.stamp_ns);
    last_obeyed_ns_ = obeyed.stamp_ns;
  }
  if (stamp_ns < window_end_ns_) return;
  if (ages_.count() > 0) {
    figures_ = {ages_.quantile_ns(0.5), ages_.quantile_ns(0.95)};
    ages_.reset();
    window_end_ns_ = stamp_ns + kWindowNs;
  } else if (stamp_ns >= window_end_ns_ + kWindowNs) {
    figures_ = {};
  }
}

}  // namespace swiftlet::services

#include "swiftlet/services/control/delay_monitor.hpp"

#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::services {

const DelayMonitor::Report& DelayMonitor::update(const LoopDelay::Figures& measured,
                                                 const control::ControlGains& gains, bool settled) {
  if (!known_ || (settled && gains != gains_)) {
    report_.margin_s = control::least_flown_delay_margin(gains, rotors_);
    report_.near_margin = false;
    gains_ = gains;
    known_ = true;
  }
  const bool is_measured = measured.p95_ns >= 0;
  report_.p50_s = is_measured ? static_cast<double>(measured.p50_ns) * 1e-9 : -1.0;
  report_.p95_s = is_measured ? static_cast<double>(measured.p95_ns) * 1e-9 : -1.0;
  const bool was_near = report_.near_margin;
  report_.near_margin = report_.p95_s > (was_near ? kOffShare : kNearShare) * report_.margin_s;
  if (report_.near_margin && !was_near) {
    runtime::log_warning(
        "the loop's delay is {:.0f} ms, and {:.0f} ms make it unstable: fly gains for this delay, see "
        "`swiftlet tune delay --help`",
        1e3 * report_.p95_s, 1e3 * report_.margin_s);
  } else if (was_near && !report_.near_margin && is_measured) {
    runtime::log_info("the loop's delay is {:.0f} ms again", 1e3 * report_.p95_s);
  }
  return report_;
}

}  // namespace swiftlet::services

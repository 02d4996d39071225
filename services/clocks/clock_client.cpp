#include "swiftlet/services/clocks/clock_client.hpp"

#include <utility>

#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::clocks {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kStatusPeriod{500};
// Replies of another process count once those of the first have ceased for this long.
constexpr std::chrono::milliseconds kSourceSilence{1500};

}  // namespace

ClockClient::ClockClient(dds::Node& node, std::function<std::int64_t()> own_ns, Reporting reporting)
    : own_ns_(std::move(own_ns)),
      id_(runtime::random_id()),
      requests_(node.publish(messages::topics::kClockRequest)),
      status_(reporting == Reporting::kPublished ? std::optional(node.publish(messages::topics::kClockStatus))
                                                 : std::nullopt),
      replies_(node.subscribe<messages::msg::ClockReply>(
          messages::topics::kClockReply, [this](const messages::msg::ClockReply& reply) { take(reply); },
          dds::Delivery::kShared, dds::OneSource{kSourceSilence})) {}

void ClockClient::ask_if_due() {
  latest_.take(known_);
  const Time now = Clock::now();
  if (now < due_) return;
  due_ = now + (known_.is_certain ? kPeriod : kFirstPeriod);
  messages::msg::ClockRequest request;
  request.client(id_);
  request.sequence_number(++requests_sent_);
  request.sent_ns(own_ns_());
  requests_.publish(request);
}

std::optional<std::int64_t> ClockClient::to_vehicle(std::int64_t own_ns) {
  latest_.take(known_);
  if (!known_.is_certain) return std::nullopt;
  return own_ns + known_.clock.offset_at(own_ns);
}

void ClockClient::take(const messages::msg::ClockReply& reply) {
  const std::int64_t now_ns = own_ns_();
  const std::uint64_t number = reply.sequence_number();
  if (reply.client() != id_ || number <= last_answered_ || number > requests_sent_) return;
  if (filter_.add({reply.sent_ns(), reply.received_ns(), reply.answered_ns(), now_ns}) != nullptr) return;
  last_answered_ = number;
  const ClockEstimate& clock = *filter_.estimate();
  const bool is_certain = filter_.exchanges() >= ClockFilter::kStepExchanges && !filter_.is_in_doubt();
  latest_.put({clock, is_certain});
  if (!status_) return;
  log_changes(is_certain, clock, now_ns);
  publish_status(is_certain, clock, now_ns);
}

void ClockClient::log_changes(bool is_known, const ClockEstimate& clock, std::int64_t now_ns) {
  const double offset_s = -1e-9 * static_cast<double>(clock.offset_at(now_ns));
  const double uncertainty_ms = 1e-6 * clock.uncertainty_ns(now_ns);
  if (filter_.steps() > steps_logged_) {
    runtime::log_warning(
        "a clock was set: that of the frames minus the vehicle's is now {:+.6f} s (within {:.3f} ms)",
        offset_s, uncertainty_ms);
  } else if (is_known && !was_known_) {
    runtime::log_info("clock of the frames minus the vehicle's: {:+.6f} s (within {:.3f} ms)", offset_s,
                      uncertainty_ms);
  }
  steps_logged_ = filter_.steps();
  was_known_ = was_known_ || is_known;
}

void ClockClient::publish_status(bool is_known, const ClockEstimate& clock, std::int64_t now_ns) {
  const Time now = Clock::now();
  if (now < status_due_) return;
  status_due_ = now + kStatusPeriod;
  messages::msg::ClockStatus status;
  status.stamp_ns(now_ns + clock.offset_at(now_ns));
  status.sequence_number(++statuses_);
  status.offset_ns(-clock.offset_at(now_ns));
  status.drift(-clock.drift);
  status.drift_uncertainty(2.0 * clock.drift_deviation);
  status.uncertainty_ns(clock.uncertainty_ns(now_ns));
  status.round_trip_ns(2.0 * clock.half_round_trip_ns);
  status.steps(static_cast<std::uint32_t>(filter_.steps()));
  status.known(is_known);
  status_->publish(status);
}

}  // namespace swiftlet::clocks

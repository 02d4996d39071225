#include "swiftlet/services/clocks/clock_server.hpp"

#include <utility>

namespace swiftlet::comms {

ClockServer::ClockServer(Node& node, std::function<std::optional<std::int64_t>()> now_ns)
    : now_ns_(std::move(now_ns)),
      replies_(node.publish(topics::kClockReply)),
      requests_(node.subscribe<msg::ClockRequest>(
          topics::kClockRequest, [this](const msg::ClockRequest& request) { answer(request); })) {}

void ClockServer::answer(const msg::ClockRequest& request) {
  const std::optional<std::int64_t> received_ns = now_ns_();
  if (!received_ns) return;
  msg::ClockReply reply;
  reply.client(request.client());
  reply.sequence_number(request.sequence_number());
  reply.sent_ns(request.sent_ns());
  reply.received_ns(*received_ns);
  reply.answered_ns(now_ns_().value_or(*received_ns));
  replies_.publish(reply);
}

}  // namespace swiftlet::comms

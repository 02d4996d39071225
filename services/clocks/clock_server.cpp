#include "swiftlet/services/clocks/clock_server.hpp"

#include <utility>

namespace swiftlet::clocks {

ClockServer::ClockServer(dds::Node& node, std::function<std::optional<std::int64_t>()> now_ns)
    : now_ns_(std::move(now_ns)),
      replies_(node.publish(messages::topics::kClockReply)),
      requests_(node.subscribe<messages::msg::ClockRequest>(
          messages::topics::kClockRequest,
          [this](const messages::msg::ClockRequest& request) { answer(request); })) {}

void ClockServer::answer(const messages::msg::ClockRequest& request) {
  const std::optional<std::int64_t> received_ns = now_ns_();
  if (!received_ns) return;
  messages::msg::ClockReply reply;
  reply.client(request.client());
  reply.sequence_number(request.sequence_number());
  reply.sent_ns(request.sent_ns());
  reply.received_ns(*received_ns);
  reply.answered_ns(now_ns_().value_or(*received_ns));
  replies_.publish(reply);
}

}  // namespace swiftlet::clocks

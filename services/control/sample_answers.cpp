#include "swiftlet/services/control/sample_answers.hpp"

#include <variant>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {

SampleAnswers::SampleAnswers(InnerLoop& loop, CommandPublisher& commands, Semaphore& wake, dds::Node& node,
                             std::uint64_t controller, int failover_priority, int rotor_count)
    : loop_(loop),
      commands_(commands),
      wake_(wake),
      reports_(node.publish(messages::topics::kControllerState)) {
  report_.controller = controller;
  report_.failover_priority = failover_priority;
  report_.rotor_count = rotor_count;
}

void SampleAnswers::answer(const VehicleSample& sample, const Authority& authority) {
  const std::int64_t arrived_ns = runtime::monotonic_ns();
  authority_ = authority;
  loop_.set_obeyed(sample.obeyed, authority.role, authority.term);
  if (restarts_.sample(sample)) loop_.restart_vehicle(arrived_ns);
  last_answer_ = std::visit(
      [&](const auto& motion) {
        return loop_.step(motion, arrived_ns, authority.role, authority.followed_term);
      },
      sample.motion);
  plant::header_of(last_answer_).term = authority.term;
  publish_command();
  finish();
  if (loop_.report_due()) report(sample.stamp_ns());
}

void SampleAnswers::repeat() {
  loop_.answer_requests();
  publish_command();
  finish();
}

void SampleAnswers::publish_command() {
  if (authority_.role == Role::kActive && !loop_.detecting_airborne()) commands_.publish(last_answer_);
}

void SampleAnswers::finish() {
  if (loop_.finish(runtime::monotonic_ns(), authority_.loop_delay)) wake_.post();
}

void SampleAnswers::report(std::int64_t stamp_ns) {
  report_.stamp_ns = stamp_ns;
  ++report_.sequence;
  report_.term = authority_.term;
  loop_.report(report_);
  reports_.publish(messages::to_message(report_));
}

}  // namespace swiftlet::services

#include "swiftlet/control/supervision/setpoint_way.hpp"

#include "swiftlet/control/guidance/setpoint_stream.hpp"

namespace swiftlet::control {

const PolynomialSegment& way_into_setpoint(const SupervisorContext& context) {
  if (!context.way_taken) {
    const Reference from = context.state.guidance.path.at(context.state.now_ns);
    context.way_taken = blend(context.limits, from, *context.setpoint, context.setpoint_period_s);
  }
  return *context.way_taken;
}

}  // namespace swiftlet::control

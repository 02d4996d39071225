#include "swiftlet/control/supervision/setpoint_path.hpp"

#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/guidance/setpoint_stream.hpp"

namespace swiftlet::control {

const PolynomialSegment& path_to_setpoint(const SupervisorContext& context) {
  if (!context.setpoint_path) {
    const Reference from = reference_on_path(context.guidance(), context.state.now_ns);
    context.setpoint_path = blend(context.limits, from, *context.setpoint, context.setpoint_period_s);
  }
  return *context.setpoint_path;
}

}  // namespace swiftlet::control

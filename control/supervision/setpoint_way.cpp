#include "swiftlet/control/supervision/setpoint_way.hpp"

#include "swiftlet/control/guidance/setpoint_stream.hpp"

namespace swiftlet::control {

const PolynomialSegment& way_into_setpoint(const Scene& scene) {
  if (!scene.way_taken) {
    const Reference from = scene.state.guidance.path.at(scene.state.now_ns);
    scene.way_taken = blend(scene.limits, from, *scene.setpoint, scene.setpoint_period_s);
  }
  return *scene.way_taken;
}

}  // namespace swiftlet::control

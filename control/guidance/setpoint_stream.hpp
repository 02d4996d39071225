// Streams of setpoints. Those of position, velocity and acceleration become a reference: from each to the
// next it moves smoothly, within the limits, however seldom they come. Those of attitude and body rates go
// past the position loop, and the reference is where the vehicle is.
#pragma once

#include "swiftlet/control/guidance/guidance_context.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

// From the reference as it is into what the setpoint asks for: position, velocity, acceleration and jerk go
// over without a step. It takes period_s, the time until the next setpoint, at the end of which the reference
// is where the setpoint, going on by itself, would be by then; or as much longer as speed, acceleration and
// jerk need to stay within the limits. Where nothing is gentle and inside the fence, the gentlest that is
// inside. A heading that cannot be reached in that time at max_yaw_rate is turned to as far as it goes.
PolynomialSegment blend(const Limits& limits, const Reference& from, const Setpoint& to, double period_s);

// The reference after_s after a blend that was begun from there: at its end it goes on with constant
// acceleration.
Reference after_blend(const PolynomialSegment& blend, double after_s);

// On with constant acceleration and yaw rate.
PolynomialSegment coast(const Reference& from, double duration_s);

// A way from the reference as it is, as of blend().
void follow_way(const GuidanceContext& context, const PolynomialSegment& way);
// After a blend, while the next setpoint is awaited.
void start_coast(const GuidanceContext& context);
// Takes an attitude or body rates, which directive() then asks for.
void take_direct(const GuidanceContext& context, const Setpoint& setpoint);
// Pins the reference where the vehicle is, with its velocity and the acceleration that its thrust gives it.
void follow_estimate(const GuidanceContext& context);

// The time to the next setpoint, by that since the last, of those that the mode of now follows.
double stream_period_s(const GuidanceContext& context);

// Where the estimated vehicle could come to rest lies outside the fence.
bool violates_fence(const GuidanceContext& context);

}  // namespace swiftlet::control

// Setpoint streams. Position, velocity and acceleration setpoints become a reference that moves smoothly
// from each setpoint to the next, within the limits, at any stream rate. Attitude and body-rate setpoints
// bypass the position loop; the reference is then the vehicle's own state.
#pragma once

#include "swiftlet/control/guidance/guidance_context.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

// A segment from the present reference to the setpoint, continuous in position, velocity, acceleration and
// jerk. It takes period_s, the time until the next setpoint, and ends where the extrapolated setpoint is
// then. It takes longer where speed, acceleration and jerk need that to stay within the limits. If no
// duration keeps the limits inside the fence, the one with the least acceleration and jerk inside the fence
// is taken. Yaw turns as far as max_yaw_rate allows in the time.
PolynomialSegment blend(const Limits& limits, const Reference& from, const Setpoint& to, double period_s);

// The reference after_s after the start of a blend. Beyond the blend's end it coasts.
Reference after_blend(const PolynomialSegment& blend, double after_s);

// Motion at constant acceleration and yaw rate.
PolynomialSegment coast(const Reference& from, double duration_s);

// Follows a segment that starts at the present reference, such as a blend().
void follow_path(const GuidanceContext& context, const PolynomialSegment& segment);
// After a blend, coasts until the next setpoint arrives.
void start_coast(const GuidanceContext& context);
// Stores an attitude or body-rate setpoint, which Supervisor::step() then outputs.
void take_direct(const GuidanceContext& context, const Setpoint& setpoint);
// Sets the reference to the vehicle's position and velocity, and the acceleration that its thrust gives.
void follow_estimate(const GuidanceContext& context);

// Estimated time to the next setpoint: the time since the last one that the present mode follows.
double stream_period_s(const GuidanceContext& context);

// True if the stopping point of the vehicle's motion is outside the fence or below the minimum height.
bool violates_fence(const GuidanceContext& context);

}  // namespace swiftlet::control

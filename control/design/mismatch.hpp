// The loops when the vehicle flown differs from the one that the gains were designed for.
#pragma once

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// Phase margins in degrees, cut as those of ControlDesign; at most 0 for an unstable loop.
struct PhaseMargins {
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
  double x = 0.0, y = 0.0, z = 0.0;
};

// The six loops, cut in the same places.
struct LoopSet {
  Loop roll, pitch, yaw;
  Loop x, y, z;
};

// The gains of `design`, made for `designed`, on the vehicle `flown`: linear about its hover at this supply
// voltage, with equal rotor shares. The controller's nominal inverse of Eq. (25), (22), (9) and the
// vehicle's own Eq. (9), (22), (25) combine to a gain beside the rotor lag. Estimator, sampling, latency and
// drag are left out, as in ControlDesign. Both vehicles must pass validate().
LoopSet loops_on(const ControlDesign& design, const plant::Vehicle& designed, const plant::Vehicle& flown,
                 double supply_voltage_v);
PhaseMargins margins_on(const ControlDesign& design, const plant::Vehicle& designed,
                        const plant::Vehicle& flown, double supply_voltage_v);

}  // namespace swiftlet::control

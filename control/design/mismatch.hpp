// The loops as they are when the vehicle that flies is not the one that they were designed on.
#pragma once

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// Phase margins in degrees, cut where those of ControlDesign are; at most 0 for a loop that is not stable.
struct PhaseMargins {
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
  double x = 0.0, y = 0.0, z = 0.0;
};

// The six loops, cut likewise.
struct LoopSet {
  Loop roll, pitch, yaw;
  Loop x, y, z;
};

// Gains of `design`, which was made for `designed`, on `flown`: linear about the hover of `flown` at this
// supply voltage, every rotor with an equal share. What the command becomes on its way through the nominal
// inverse of Eq. (25), (22), (9) and the vehicle's own Eq. (9), (22), (25) is a gain beside the rotor lag.
// Estimator, sampling, latency and drag are left out, as in ControlDesign. Both vehicles pass validate().
LoopSet loops_on(const ControlDesign& design, const plant::Vehicle& designed, const plant::Vehicle& flown,
                 double supply_voltage_v);
PhaseMargins margins_on(const ControlDesign& design, const plant::Vehicle& designed,
                        const plant::Vehicle& flown, double supply_voltage_v);

}  // namespace swiftlet::control

// Turns a request for other control settings into a change of gains that the inner loop takes over: checks
// the settings, designs the gains, checks the stability of all loops on the way to them.
#pragma once

#include <vector>

#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings_request.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::services {

class GainDesigner {
 public:
  // settings: those that the controller was started with. fixed: their part that cannot change.
  GainDesigner(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
               std::vector<control::FixedSetting> fixed = {});

  // The gains of the settings that the controller was started with.
  const control::ControlGains& initial() const { return initial_; }

  // Designs the gains and fills in `change`, from `in_force`. Refuses with a sentence that names the key.
  // Takes up to some 100 ms and allocates memory: not for the inner loop.
  control::Outcome design(const control::SettingsRequest& asked, const control::ControlGains& in_force,
                          control::GainChange& change) const;

 private:
  control::Outcome check_fixed(const std::vector<control::FixedSetting>& asked) const;

  plant::Vehicle vehicle_;
  control::ControlSettings settings_;
  std::vector<control::FixedSetting> fixed_;
  control::ControlGains initial_;
};

}  // namespace swiftlet::services

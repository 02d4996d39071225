#include "swiftlet/control/types/request.hpp"

#include <algorithm>
#include <array>

namespace swiftlet::control {
namespace {

struct Named {
  RequestKind kind;
  const char* name;
};

constexpr std::array kNames = {
    Named{RequestKind::kArm, "arm"},
    Named{RequestKind::kDisarm, "disarm"},
    Named{RequestKind::kTakeoff, "takeoff"},
    Named{RequestKind::kGoTo, "goto"},
    Named{RequestKind::kHold, "hold"},
    Named{RequestKind::kLand, "land"},
    Named{RequestKind::kStop, "stop"},
    Named{RequestKind::kMissionStart, "mission start"},
    Named{RequestKind::kMissionPause, "mission pause"},
    Named{RequestKind::kMissionResume, "mission resume"},
    Named{RequestKind::kMissionSkip, "mission skip"},
    Named{RequestKind::kMissionClear, "mission clear"},
    Named{RequestKind::kHoverTest, "hover test"},
    Named{RequestKind::kMissionUpload, "mission upload"},
    Named{RequestKind::kTrajectory, "trajectory"},
    Named{RequestKind::kSettings, "set control"},
};

}  // namespace

const char* to_string(RequestKind kind) {
  const auto* const found =
      std::find_if(kNames.begin(), kNames.end(), [kind](const Named& one) { return one.kind == kind; });
  return found == kNames.end() ? "request of unknown kind" : found->name;
}

}  // namespace swiftlet::control

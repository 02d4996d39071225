// How the manoeuvres of a vehicle run: which telemetry says that one is done, and which that it ended
// otherwise.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/manoeuvre.hpp"

namespace swiftlet::ground {

// How things stood. What was told before the answer may still arrive after it.
struct Outset {
  control::Mode mode = control::Mode::kDisarmed;  // before it was asked
  std::uint64_t statuses = 0;                     // that had come when it was answered
  std::uint64_t references = 0;                   // likewise
  std::uint64_t missions = 0;                     // likewise, states of missions
};

// By the view: how the manoeuvre ended, or nothing while it is under way.
using Judge = std::function<std::optional<Ending>(const View& view, const Outset& outset)>;

struct Manoeuvre::Course {
  std::shared_ptr<const Client> client;
  Answer answer;
  Outset outset;
  Judge judge;
};

// Done when it is accepted.
Judge at_once();
// Done in the mode `goal`; `way` is the mode that leads there, or the goal itself.
Judge until_mode(control::Mode goal, control::Mode way);
Judge until_stopped();
// Done on the ground, by way of landing or of the descent without position.
Judge until_landed();
// Done when the vehicle rests at the place, or, without one, wherever its reference rests.
Judge until_at_rest(const std::optional<Eigen::Vector3d>& place_ned);
Judge until_trajectory_flown();
Judge until_mission_flown(std::uint64_t mission_id);

}  // namespace swiftlet::ground

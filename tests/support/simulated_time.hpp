// Processes in simulated time, which waits for their answers: a busy machine slows a flight down and changes nothing else.
// Processes may die and stand still all the same: time goes on without them.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::tests {

// The time for which tools of the ground and a test must be answered or scheduled by a busy machine is this many times as
// long for the vehicle.
constexpr const char* kSpeed = "8";

// Arguments of swiftlet-plant. Control runs by its samples, as in real time, and may have standbys; motion capture runs in
// lockstep.
inline std::vector<std::string> plant_in_simulated_time(const std::vector<std::string>& more = {},
                                                        const std::string& speed = kSpeed) {
  // Shorter than the time for which a standby remembers a controller, 1 s.
  std::vector<std::string> words{"--clock", "lockstep", "--patience", "0.5", "--go-on", "--speed", speed};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}
inline std::vector<std::string> mocap_in_simulated_time() { return {"--clock", "lockstep"}; }

}  // namespace swiftlet::tests

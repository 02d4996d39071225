#include <chrono>
#include <iterator>
#include <optional>
#include <string>
#include <thread>

#include "swiftlet/ground/cli/check/steps.hpp"
#include "swiftlet/ground/vehicle_check/motion_watch.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kReactionPoll = 5ms;
constexpr auto kStepTime = 60s;
constexpr auto kPoseTime = 5s;  // without a pose

struct Instruction {
  HandStep step;
  const char* text;
};
constexpr Instruction kInstructions[] = {
    {HandStep::kRollRight, "roll it to the right: right side down by about 45 degrees, and hold it"},
    {HandStep::kBack, "level again, and hold it"},
    {HandStep::kNoseUp, "nose up by about 45 degrees, and hold it"},
    {HandStep::kBack, "level again, and hold it"},
    {HandStep::kTurnRight,
     "turn it to the right, clockwise seen from above, by about 90 degrees, and hold it"},
    {HandStep::kForward, "move it along its nose by about half a metre, level, and hold it"},
    {HandStep::kUp, "lift it by about half a metre, and hold it"},
    {HandStep::kWave, "turn it to and fro quickly about all axes for five seconds, then hold it"},
};

}  // namespace

std::vector<HandSegment> guide_hand(const SampleRecorder& recorder, const OperatorDialog& dialog) {
  dialog.say(
      "Take the vehicle in the hand, level. Each step ends when it rests for a second; no key is needed.");
  MotionWatch watch;
  std::int64_t last_ns = 0;
  // Feeds the poses to the watch. False if it is not done within the time of a step, or no pose comes.
  const auto follow = [&](const auto& is_done) {
    const auto end = Clock::now() + kStepTime;
    auto pose_due = Clock::now() + kPoseTime;
    while (Clock::now() < end && Clock::now() < pose_due) {
      dialog.require_going_on();
      const auto pose = recorder.newest_tracked_pose();
      if (pose && pose->received_ns != last_ns) {
        last_ns = pose->received_ns;
        pose_due = Clock::now() + kPoseTime;
        if (is_done(watch.update(pose->sample, pose->received_ns))) return true;
      }
      std::this_thread::sleep_for(kReactionPoll);
    }
    return false;
  };
  std::vector<HandSegment> segments;
  if (!follow([&](const auto&) { return watch.is_ready(); })) {
    dialog.say("motion capture does not see the vehicle at rest");
    return segments;
  }
  int number = 0;
  for (const Instruction& instruction : kInstructions) {
    dialog.say("step " + std::to_string(++number) + " of " + std::to_string(std::size(kInstructions)) + ": " +
               instruction.text);
    watch.expect(instruction.step);
    const bool seen = follow([&](const std::optional<HandSegment>& ended) {
      if (ended) segments.push_back(*ended);
      return ended.has_value();
    });
    if (!seen) {
      dialog.say("motion capture did not see this motion");
      break;
    }
  }
  return segments;
}

}  // namespace swiftlet::ground

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

// Feeds the poses to the watch.
class HandFollower {
 public:
  HandFollower(const SampleRecorder& recorder, const OperatorDialog& dialog)
      : recorder_(recorder), dialog_(dialog) {}

  // False if it is not seen at rest within the time.
  bool wait_for_rest() {
    return follow([&](const std::optional<HandSegment>&) { return watch_.is_ready(); });
  }
  std::optional<HandSegment> wait_for(HandStep step) {
    watch_.expect(step);
    std::optional<HandSegment> segment;
    follow([&](const std::optional<HandSegment>& ended) {
      segment = ended;
      return segment.has_value();
    });
    return segment;
  }

 private:
  template <class Done>
  bool follow(Done done) {
    const auto end = Clock::now() + kStepTime;
    auto pose_due = Clock::now() + kPoseTime;
    while (Clock::now() < end && Clock::now() < pose_due) {
      dialog_.require_going_on();
      const auto pose = recorder_.newest_tracked_pose();
      if (pose && pose->received_ns != last_ns_) {
        last_ns_ = pose->received_ns;
        pose_due = Clock::now() + kPoseTime;
        if (done(watch_.update(pose->sample, pose->received_ns))) return true;
      }
      std::this_thread::sleep_for(kReactionPoll);
    }
    return false;
  }

  const SampleRecorder& recorder_;
  const OperatorDialog& dialog_;
  MotionWatch watch_;
  std::int64_t last_ns_ = 0;
};

}  // namespace

std::vector<HandSegment> guide_hand(const SampleRecorder& recorder, const OperatorDialog& dialog) {
  dialog.say(
      "Take the vehicle in the hand, level. Each step ends when it rests for a second; no key is needed.");
  HandFollower follower(recorder, dialog);
  std::vector<HandSegment> segments;
  if (!follower.wait_for_rest()) {
    dialog.say("motion capture does not see the vehicle at rest");
    return segments;
  }
  int number = 0;
  for (const Instruction& instruction : kInstructions) {
    dialog.say("step " + std::to_string(++number) + " of " + std::to_string(std::size(kInstructions)) + ": " +
               instruction.text);
    const auto segment = follower.wait_for(instruction.step);
    if (!segment) {
      dialog.say("motion capture did not see this motion");
      break;
    }
    segments.push_back(*segment);
  }
  return segments;
}

}  // namespace swiftlet::ground

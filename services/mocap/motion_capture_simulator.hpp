// Motion capture of one vehicle, simulated: receives its ground truth, publishes its poses.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

// Whose clock stamps the frames.
enum class FrameClock {
  kVehicle,  // the stamps of ground_truth
  kHost,     // the system clock of this host, as cameras do; the stamps are translated to the vehicle's clock
};

struct MotionCaptureSettings {
  plant::SimulationSettings simulation;
  std::uint64_t seed = 1;
  runtime::Clock clock = runtime::Clock::kRealtime;
  FrameClock frame_clock = FrameClock::kVehicle;  // kHost: in real time at speed 1 only
  runtime::RealtimeSettings realtime;
};

// Runs in the thread that receives ground_truth. In lockstep a lost sample of it ends the vehicle: its frame cannot be
// made.
class MotionCaptureSimulator final : public runtime::HostedVehicle {
 public:
  MotionCaptureSimulator(const dds::Participant& participant, const std::string& vehicle,
                         const MotionCaptureSettings& settings);

  void run(const std::atomic<bool>&) override {}
  void log_end() override;

 private:
  void on_truth(const messages::msg::GroundTruth& message);
  // Gives a frame the stamp that a camera with the host's clock gives it, translated. Returns false if that is unknown.
  bool stamp_by_host(plant::PoseSample& pose, std::int64_t truth_stamp_ns, std::int64_t arrived_ns);
  bool is_next(const plant::TruthSample& truth);
  void answer_again(std::int64_t stamp_ns);
  void publish_heartbeat(std::int64_t stamp_ns);

  dds::Node node_;
  plant::Mocap mocap_;
  plant::MocapPath path_;
  runtime::RealtimeSettings realtime_;
  runtime::Clock clock_;
  std::uint64_t truth_sequence_ = 0;
  messages::msg::MocapPose last_pose_;  // sequence 0 before the first frame
  bool made_frame_ = false;             // of the newest truth
  bool heartbeat_is_next_ = false;
  runtime::RealtimeThread thread_;
  bool logged_fault_ = false;
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> untracked_{0};
  std::atomic<std::uint64_t> withheld_{0};
  dds::Publisher<messages::msg::MocapPose> poses_;
  std::optional<clocks::ClockClient> host_clock_;
  dds::Subscription truth_;  // last: its callback uses all members above
};

}  // namespace swiftlet::services

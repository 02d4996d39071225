// Publishes the poses of one vehicle from a real motion capture.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "swiftlet/io/mocap/room.hpp"
#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/mocap/frame_thread.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"
#include "swiftlet/services/runtime/hosting.hpp"

namespace swiftlet::services {

// Works in the thread that receives the frames.
class CapturedVehicle final : public runtime::HostedVehicle, public FrameTaker {
 public:
  CapturedVehicle(const dds::Participant& participant, const mocap::VehicleBody& body,
                  const mocap::RoomFrame& room_frame, FrameThread& frames);
  ~CapturedVehicle() override;

  void run(const std::atomic<bool>&) override {}
  bool goes_on() const override { return frames_.goes_on(); }
  void log_end() override;

  void take(const mocap::SourceFrame& frame, const mocap::Source& source) override;
  void wait_for_frame() override;
  void end(const std::string& why) override { fail(why); }

 private:
  void find_body(const mocap::Source& source);
  void warn_if_missing(const mocap::SourceFrame& frame, const mocap::Source& source);
  // The pose of the vehicle in a frame; nullopt: the frame is about other bodies.
  std::optional<plant::PoseSample> sample_of(const mocap::SourceFrame& frame) const;

  const mocap::VehicleBody body_;
  const mocap::RoomFrame room_frame_;
  FrameThread& frames_;
  std::optional<std::size_t> index_;            // of the body in the source's list
  std::uint64_t revision_ = ~std::uint64_t{0};  // none of a source
  std::optional<std::int64_t> missing_since_ns_;
  bool has_warned_ = false;
  std::uint64_t sequence_ = 0;
  std::uint64_t untracked_ = 0;
  std::uint64_t withheld_ = 0;
  dds::Node node_;
  dds::Publisher<messages::msg::MocapPose> poses_;
  clocks::ClockClient clock_;
};

}  // namespace swiftlet::services

#include "swiftlet/services/mocap/captured_vehicle.hpp"

#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::int64_t kPatienceNs = 2'000'000'000;  // until a body that is missing is warned of

}  // namespace

CapturedVehicle::CapturedVehicle(const dds::Participant& participant, const mocap::VehicleBody& body,
                                 const mocap::RoomFrame& room_frame, FrameThread& frames)
    : HostedVehicle(body.vehicle),
      body_(body),
      room_frame_(room_frame),
      frames_(frames),
      node_(participant, body.vehicle, [this](const std::string& fault) { fail(fault); }),
      poses_(node_.publish(messages::topics::kMocapPose)),
      clock_(node_, runtime::monotonic_ns) {
  dds::log_peers(node_);
  frames_.add(*this);
}

CapturedVehicle::~CapturedVehicle() { frames_.remove(*this); }

void CapturedVehicle::log_end() {
  frames_.remove(*this);
  runtime::log_info("ended: {} frames, {} untracked{}", sequence_, untracked_,
                    withheld_ == 0 ? "" : fmt::format(", {} withheld: a clock was unknown", withheld_));
}

void CapturedVehicle::wait_for_frame() { clock_.ask_if_due(); }

void CapturedVehicle::take(const mocap::SourceFrame& frame, const mocap::Source& source) {
  clock_.ask_if_due();
  if (source.revision() != revision_) find_body(source);
  warn_if_missing(frame, source);
  std::optional<plant::PoseSample> sample = sample_of(frame);
  if (!sample) return;
  const std::optional<std::int64_t> stamp_ns =
      frame.exposed_ns ? clock_.to_vehicle(*frame.exposed_ns) : std::nullopt;
  if (!stamp_ns) {
    ++withheld_;
    return;
  }
  sample->stamp_ns = *stamp_ns;
  sample->sequence = ++sequence_;
  if (!sample->tracked) ++untracked_;
  poses_.publish(messages::to_message(*sample));
}

void CapturedVehicle::find_body(const mocap::Source& source) {
  const bool was_missing = !index_;
  revision_ = source.revision();
  index_ = mocap::find_body(source.bodies(), body_);
  if (!index_ || !was_missing) return;
  const mocap::Body& body = source.bodies()[*index_];
  runtime::log_info("{} is body '{}' with number {}", name(), io::printable(body.name), body.id);
}

void CapturedVehicle::warn_if_missing(const mocap::SourceFrame& frame, const mocap::Source& source) {
  if (index_) {
    missing_since_ns_.reset();
    has_warned_ = false;
    return;
  }
  if (!missing_since_ns_) missing_since_ns_ = frame.arrived_ns;
  if (has_warned_ || frame.arrived_ns - *missing_since_ns_ < kPatienceNs) return;
  has_warned_ = true;
  runtime::log_warning("the motion capture has no {}; it has {}", body_.body_text(),
                       io::printable(mocap::to_string(source.bodies())));
}

std::optional<plant::PoseSample> CapturedVehicle::sample_of(const mocap::SourceFrame& frame) const {
  plant::PoseSample sample;
  for (const mocap::BodyPose& pose : frame.poses) {
    if (!index_ || pose.body != *index_) continue;
    sample.tracked = pose.tracked;
    if (!pose.tracked) return sample;
    const mocap::NedPose ned = room_frame_.vehicle_pose(pose.position, pose.q_room_from_body, body_);
    sample.position_ned = ned.position_ned;
    sample.q_ned_from_frd = ned.q_ned_from_frd;
    return sample;
  }
  if (!frame.is_complete) return std::nullopt;
  return sample;
}

}  // namespace swiftlet::services

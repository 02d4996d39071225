#include "swiftlet/ground/flight/simulated_recorder.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "swiftlet/ground/flight/flight_description.hpp"
#include "swiftlet/plant/model/telemetry_rate.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/file/recorded_faults.hpp"
#include "swiftlet/services/dds/payload.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/schemas.hpp"
#include "swiftlet/services/messages/vehicle_info.hpp"

namespace swiftlet::ground {
namespace {

namespace topics = messages::topics;

constexpr const char* kVehicle = "kl1";
constexpr std::uint64_t kClient = 1;                // the only one
constexpr std::uint64_t kFirstRequest = 1'000'000;  // above the ids of missions
constexpr std::int64_t kStatusPeriod_ns = 1'000'000'000;

bool differ(const control::MissionProgress& a, const control::MissionProgress& b) {
  return a.id != b.id || a.state != b.state || a.item_index != b.item_index;
}

bool is_over(control::MissionState state) {
  return state == control::MissionState::kCompleted || state == control::MissionState::kAborted;
}

}  // namespace

SimulatedRecorder::SimulatedRecorder(simulation::ClosedLoop& loop, const LaunchConfiguration& plan,
                                     const std::string& program)
    : loop_(loop),
      imu_period_ns_(plant::period_ns(loop.imu_rate_hz)),
      truth_due_(plan.simulation),
      failsafe_(plan.control.failsafe),
      file_(plan.folder / record::kFlightFile, writer_settings(program), true) {
  messages::describe(plan.vehicle, vehicle_info_);
  vehicle_info_.simulated(true);
  vehicle_info_.imu_rate_hz(loop.imu_rate_hz);
  vehicle_info_.control_levels(plan.simulation.control_levels.bits());
  const Fleet fleet{{kVehicle}, {plan}, plan.folder, program};
  attempt([&] {
    file_.write(record::recorder_metadata(record::RecordClock::kVehicle));
    file_.write(flight_metadata(fleet));
    for (const mcap::Attachment& attachment : flight_attachments(fleet)) file_.write(attachment);
  });
  write_vehicle_info();
  if (loop.answered) {  // at stamp 0, before anything could listen
    plant::TelemetryPacket first{loop.plant.samples(), *loop.answered, loop.answered_odometry, {}};
    first.obeyed.reported = true;
    write_sample(first, std::nullopt);
    step();
  }
  loop.on_answered = [this](const plant::TelemetryPacket& packet,
                            const std::optional<plant::PoseSample>& pose) { write_sample(packet, pose); };
}

SimulatedRecorder::~SimulatedRecorder() { loop_.on_answered = nullptr; }

template <class Work>
void SimulatedRecorder::attempt(const Work& work) {
  if (!fault_.empty()) return;
  try {
    work();
  } catch (const std::exception& fault) {
    fault_ = fault.what();
  }
}

template <class T>
void SimulatedRecorder::write(const messages::Topic<T>& topic, const T& message, std::int64_t time_ns) {
  attempt([&] {
    auto channel = channels_.find(topic.name);
    if (channel == channels_.end()) {
      const std::uint16_t id = file_.add_channel(kVehicle, topic.name, messages::schema_of<T>());
      channel = channels_.emplace(topic.name, id).first;
    }
    const std::vector<std::uint8_t> payload = dds::to_payload(message);
    file_.write(mcap::Message{
        channel->second, ++counts_[channel->second], time_ns, time_ns, {payload.data(), payload.size()}});
  });
}

void SimulatedRecorder::write_sample(const plant::TelemetryPacket& packet,
                                     const std::optional<plant::PoseSample>& pose) {
  const std::int64_t now_ns = loop_.plant.stamp_ns();
  plant::for_each_sensor(
      [&](const auto& sample, std::uint64_t& sequence) {
        if (!sample) return;
        sequence = sample->sequence;
        const auto message = messages::to_message(*sample);
        write(messages::topic_of(message), message, now_ns);
      },
      packet, inputs_);
  if (pose) {
    inputs_.mocap_pose = pose->sequence;
    write(topics::kMocapPose, messages::to_message(*pose), now_ns);
  }
  const auto write_answered = [&](const auto& topic, auto message) {
    message.obeyed(messages::to_message(packet.obeyed));
    message.lockstep(messages::to_message(inputs_));
    write(topic, message, now_ns);
  };
  if (packet.odometry) {
    write_answered(topics::kVehicleOdometry, messages::to_message(*packet.odometry));
  } else {
    write_answered(topics::kImu, messages::to_message(packet.imu));
  }
  write_command(now_ns);
}

void SimulatedRecorder::write_command(std::int64_t now_ns) {
  std::visit(
      [&](const auto& command) {
        const auto message = messages::to_message(command);
        write(messages::topic_of(message), message, now_ns);
      },
      loop_.sent);
}

void SimulatedRecorder::step() {
  const std::int64_t now_ns = loop_.plant.stamp_ns();
  if (truth_due_.due(loop_.plant)) {
    messages::msg::GroundTruth truth = messages::to_message(loop_.plant.truth());
    truth.stamp_ns(now_ns);
    truth.sequence_number(++truth_sequence_);
    write(topics::kGroundTruth, truth, now_ns);
  }
  if (loop_.answered && loop_.answered->sequence != answered_sequence_) {
    const std::uint64_t before = std::exchange(answered_sequence_, loop_.answered->sequence);
    if (plant::is_telemetry_sample(answered_sequence_, before, imu_period_ns_)) write_telemetry();
  }
  write_changes();
  const bool running = loop_.command.rotor_state == plant::RotorState::kRunning;
  if (running != vehicle_info_.rotors_running() || now_ns - vehicle_info_ns_ >= kStatusPeriod_ns)
    write_vehicle_info();
}

void SimulatedRecorder::write_telemetry() {
  const control::FlightController& controller = loop_.controller;
  const control::Status& status = controller.status();
  const std::int64_t now_ns = loop_.plant.stamp_ns();
  ++telemetry_sequence_;
  messages::msg::Estimate estimate =
      messages::to_message(controller.estimate(), controller.estimate_deviation(), status.pose_age_s);
  estimate.sequence_number(telemetry_sequence_);
  write(topics::kEstimate, estimate, now_ns);
  messages::msg::Reference reference =
      messages::to_message(controller.reference(), controller.attitude_setpoint(), status.mode);
  reference.stamp_ns(loop_.answered->stamp_ns);
  reference.sequence_number(telemetry_sequence_);
  write(topics::kReference, reference, now_ns);
}

void SimulatedRecorder::write_changes() {
  const control::Status& now = loop_.controller.status();
  const std::int64_t now_ns = loop_.plant.stamp_ns();
  const bool mode_changed = !status_ || now.mode != status_->mode || now.reason != status_->reason;
  const bool mission_changed = !status_ || differ(now.mission, status_->mission);
  if (mode_changed || now_ns - status_ns_ >= kStatusPeriod_ns) write_status(now);
  if (mission_changed) mission_end_ = now.reason;
  if (mission_changed || now_ns - mission_ns_ >= kStatusPeriod_ns) write_mission(now);
  if (mode_changed || mission_changed) status_ = now;
}

void SimulatedRecorder::write_status(const control::Status& status) {
  status_ns_ = loop_.plant.stamp_ns();
  messages::msg::ControlStatus message = messages::to_message(status, loop_.controller.gains(), failsafe_);
  message.stamp_ns(status_ns_);
  message.sequence_number(++status_sequence_);
  message.rate_hz(loop_.imu_rate_hz);
  write(topics::kControlStatus, message, status_ns_);
}

void SimulatedRecorder::write_mission(const control::Status& status) {
  mission_ns_ = loop_.plant.stamp_ns();
  messages::msg::MissionStatus message = messages::to_message(status.mission);
  message.stamp_ns(mission_ns_);
  message.sequence_number(++mission_sequence_);
  if (is_over(status.mission.state)) {
    message.reason_code(static_cast<std::uint8_t>(mission_end_));
    message.reason() = control::to_string(mission_end_);
  }
  write(topics::kMissionStatus, message, mission_ns_);
}

void SimulatedRecorder::write_vehicle_info() {
  vehicle_info_ns_ = loop_.plant.stamp_ns();
  vehicle_info_.stamp_ns(vehicle_info_ns_);
  vehicle_info_.sequence_number(vehicle_info_.sequence_number() + 1);
  vehicle_info_.rotors_running(loop_.command.rotor_state == plant::RotorState::kRunning);
  write(topics::kVehicleInfo, vehicle_info_, vehicle_info_ns_);
}

void SimulatedRecorder::request(const control::Request& request, const control::Outcome& outcome) {
  const std::int64_t now_ns = loop_.plant.stamp_ns();
  ++request_sequence_;
  std::uint64_t id = kFirstRequest + request_sequence_;
  if (request.kind == control::RequestKind::kMissionUpload) {
    messages::msg::Mission mission = messages::to_message(*request.mission);
    mission.client(kClient);
    id = request.mission->id;
    mission.id(id);
    write(topics::kMission, mission, now_ns);
    if (outcome.accepted) write(topics::kFlownMission, mission, now_ns);
  } else {
    messages::msg::Command command = messages::to_message(request);
    command.client(kClient);
    command.id(id);
    write(topics::kCommand, command, now_ns);
  }
  messages::msg::CommandAck ack;
  ack.client(kClient);
  ack.id(id);
  ack.accepted(outcome.accepted);
  ack.reason() = outcome.reason;
  ack.stamp_ns(now_ns);
  write(topics::kCommandAck, ack, now_ns);
}

std::string SimulatedRecorder::finish(const std::vector<record::FaultRow>& faults) {
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  for (const record::FaultRow& fault : faults) {
    if (fault.from_ns > loop_.plant.stamp_ns()) continue;
    attempt([&] { file_.write(record::log_message(record::log_line(fault)), fault.from_ns); });
  }
  attempt([&] {
    file_.write(record::counts_metadata({{"received", messages}, {"dropped", 0}, {"lost", 0}}));
    file_.close();
  });
  return fault_;
}

}  // namespace swiftlet::ground

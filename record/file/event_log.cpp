#include "swiftlet/record/file/event_log.hpp"

#include <utility>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/cdr_writer.hpp"
#include "swiftlet/services/dds/payload.hpp"

namespace swiftlet::record {
namespace {

// The definition of foxglove's schemas for ROS 2, without its comments.
constexpr messages::MessageSchema kLog{
    "foxglove_msgs/msg/Log",
    "uint8 UNKNOWN=0\nuint8 DEBUG=1\nuint8 INFO=2\nuint8 WARNING=3\nuint8 ERROR=4\nuint8 FATAL=5\n"
    "builtin_interfaces/Time timestamp\nuint8 level\nstring message\nstring name\nstring file\nuint32 line\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
    -1};

const char* name_of(control::MissionState state) {
  switch (state) {
    case control::MissionState::kNone:
      return "no mission";
    case control::MissionState::kRunning:
      return "mission runs";
    case control::MissionState::kCompleted:
      return "mission completed";
    case control::MissionState::kAborted:
      return "mission aborted";
    case control::MissionState::kUploaded:
      return "mission uploaded";
    case control::MissionState::kPaused:
      return "mission paused";
  }
  return "mission in an unknown state";
}

template <class T>
bool read(const mcap::Message& message, T& out) {
  return dds::from_payload(message.payload.data, message.payload.size, out);
}

std::string joined(const std::string& what, const std::string& why) {
  return why.empty() ? what : what + ": " + why;
}

}  // namespace

StandardMessage log_message(const std::string& topic, std::int64_t time_ns, LogLevel level,
                            const std::string& name, const std::string& text) {
  CdrWriter out;
  out.put(static_cast<std::int32_t>(time_ns / math::kSecond_ns))
      .put(static_cast<std::uint32_t>(time_ns % math::kSecond_ns))
      .put(static_cast<std::uint8_t>(level));
  out.text(text).text(name).text("").put(std::uint32_t{0});
  return {topic, &kLog, out.take()};
}

EventLog::EventLog(std::string vehicle) : vehicle_(std::move(vehicle)) {}

StandardTopic EventLog::topic() const {
  return {"/" + vehicle_ + "/log",
          &kLog,
          {messages::topics::kControlStatus.name, messages::topics::kMissionStatus.name,
           messages::topics::kCommandAck.name, messages::topics::kVehicleInfo.name},
          true};
}

std::vector<StandardMessage> EventLog::of(const std::string& topic, const mcap::Message& message) {
  std::vector<StandardMessage> lines;
  if (topic == messages::topics::kControlStatus.name) of_control_status(message, lines);
  if (topic == messages::topics::kMissionStatus.name) of_mission_status(message, lines);
  if (topic == messages::topics::kCommandAck.name) of_command_ack(message, lines);
  if (topic == messages::topics::kVehicleInfo.name) of_vehicle_info(message, lines);
  return lines;
}

StandardMessage EventLog::line(std::int64_t time_ns, LogLevel level, const char* process,
                               const std::string& text) const {
  return log_message(topic().topic, time_ns, level, vehicle_ + "/" + process, text);
}

void EventLog::of_control_status(const mcap::Message& message, std::vector<StandardMessage>& lines) {
  messages::msg::ControlStatus status;
  if (!read(message, status)) return;
  const auto say = [&](LogLevel level, const std::string& text) {
    lines.push_back(line(message.log_time_ns, level, "control", text));
  };
  const std::string mode =
      joined(control::to_string(static_cast<control::Mode>(status.mode())), status.reason().c_str());
  if (mode != mode_) say(LogLevel::kInfo, mode);
  mode_ = mode;
  const std::string conflict = status.source_conflict().c_str();
  if (conflict != source_conflict_ && !conflict.empty()) say(LogLevel::kWarning, conflict);
  source_conflict_ = conflict;
  const std::string refusal = status.setpoint_refusal().c_str();
  if (refusal != setpoint_refusal_ && !refusal.empty())
    say(LogLevel::kWarning, "setpoint refused: " + refusal);
  setpoint_refusal_ = refusal;
}

void EventLog::of_mission_status(const mcap::Message& message, std::vector<StandardMessage>& lines) {
  messages::msg::MissionStatus status;
  if (!read(message, status)) return;
  const auto state = static_cast<control::MissionState>(status.state());
  const std::string mission = joined(name_of(state), status.reason().c_str());
  const bool first = mission_.empty() && state == control::MissionState::kNone;
  if (mission != mission_ && !first)
    lines.push_back(line(message.log_time_ns,
                         state == control::MissionState::kAborted ? LogLevel::kWarning : LogLevel::kInfo,
                         "control", mission));
  mission_ = mission;
}

void EventLog::of_command_ack(const mcap::Message& message, std::vector<StandardMessage>& lines) const {
  messages::msg::CommandAck ack;
  if (!read(message, ack)) return;
  lines.push_back(
      line(message.log_time_ns, ack.accepted() ? LogLevel::kInfo : LogLevel::kWarning, "control",
           joined(ack.accepted() ? "request accepted" : "request refused", ack.reason().c_str())));
}

void EventLog::of_vehicle_info(const mcap::Message& message, std::vector<StandardMessage>& lines) {
  messages::msg::VehicleInfo info;
  if (!read(message, info)) return;
  const std::string fault = info.fault().c_str();
  if (fault != fault_ && !fault.empty())
    lines.push_back(line(message.log_time_ns, LogLevel::kError, "vehicle", fault));
  fault_ = fault;
  if (rotors_running_ && *rotors_running_ != info.rotors_running())
    lines.push_back(line(message.log_time_ns, LogLevel::kInfo, "vehicle",
                         info.rotors_running() ? "rotors started" : "rotors stopped"));
  rotors_running_ = info.rotors_running();
}

}  // namespace swiftlet::record

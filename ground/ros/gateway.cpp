#include "swiftlet/ground/ros/gateway.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <type_traits>
#include <utility>

#include "swiftlet/services/messages/schemas.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::ros {
namespace {

messages::Fault fault_of(const std::string& sentence) {
  messages::Fault fault;
  std::snprintf(fault.text, sizeof fault.text, "%s", sentence.c_str());
  return fault;
}

template <class T>
std::int64_t stamp_of(const dds::RawSample& sample) {
  std::int64_t stamp_ns = 0;
  const auto offset = static_cast<std::size_t>(messages::schema_of<T>().stamp_offset);
  if (offset + sizeof(stamp_ns) <= sample.size)
    std::memcpy(&stamp_ns, sample.payload + offset, sizeof(stamp_ns));
  return stamp_ns;
}

}  // namespace

Gateway::Gateway(const ground::Context& context, const std::string& vehicle, const GatewaySettings& settings,
                 std::function<void(std::int64_t)> clock)
    : settings_(settings),
      clock_(std::move(clock)),
      vehicle_(context, vehicle),
      standard_(vehicle),
      node_(context.participant(), vehicle) {
  vehicle_.cancel_when([this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ending_;
  });
  for (const record::StandardTopic& one : standard_.ros_topics())
    writers_.emplace(one.topic, writer_of(node_, one.topic, one.schema->name));
  forward(messages::topics::kEstimate);
  forward(messages::topics::kReference);
  forward(messages::topics::kImu);
  forward(messages::topics::kBattery);
  goals_ = std::make_unique<Reader<PoseStamped>>(node_, "goal_pose", messages::Qos::kRequest,
                                                 [this](const Bytes& payload) { take_goal(payload); });
  velocities_ = std::make_unique<Reader<Twist>>(node_, "cmd_vel", messages::Qos::kStream,
                                                [this](const Bytes& payload) { take_velocity(payload); });
  pilot_ = std::thread([this] { fly_to_goals(); });
}

Gateway::~Gateway() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  pilot_.join();
  goals_.reset();
  velocities_.reset();
  subscriptions_.clear();
}

template <class T>
void Gateway::forward(const messages::Topic<T>& topic) {
  const bool keeps_time = std::is_same_v<T, messages::msg::Estimate>;
  subscriptions_.push_back(node_.subscribe_raw<T>(
      topic, [this, name = std::string(topic.name), keeps_time](const dds::RawSample& sample) {
        const std::int64_t time_ns =
            settings_.time == Time::kVehicle ? stamp_of<T>(sample) : runtime::system_ns();
        if (keeps_time && clock_) clock_(time_ns);
        mcap::Message message;
        message.log_time_ns = time_ns;
        message.payload = {sample.payload, sample.size};
        for (const record::StandardMessage& follows : standard_.of(name, message)) {
          if (!writers_.at(follows.topic)(follows.payload))
            write_faults_.note(fault_of(follows.topic + " of " + std::to_string(follows.payload.size()) +
                                        " bytes was not sent"));
        }
      }));
}

void Gateway::take_goal(const Bytes& payload) {
  std::string refusal;
  const std::optional<Goal> goal = goal_of(payload, vehicle_.state().position_ned_m.z(), refusal);
  if (!goal) return runtime::log_warning("{}: goal refused: {}", vehicle_.name(), refusal);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    goal_ = goal;
  }
  changed_.notify_one();
}

void Gateway::take_velocity(const Bytes& payload) {
  std::string refusal;
  const std::optional<ground::VelocitySetpoint> setpoint = velocity_of(payload, yaw_rad(), refusal);
  if (!setpoint) return velocity_faults_.note(fault_of(refusal));
  if (!vehicle_.send(*setpoint)) return velocity_faults_.note(fault_of("no controller receives them"));
  const ground::SetpointTally all = vehicle_.state().setpoints;
  const ground::SetpointTally news = all.since(setpoints_);
  setpoints_ = all;
  if (news.refused > 0) velocity_faults_.note(fault_of(news.refusal));
}

double Gateway::yaw_rad() const {
  const Eigen::Vector3d forward_ned = vehicle_.state().q_ned_from_frd * Eigen::Vector3d::UnitX();
  return std::atan2(forward_ned.y(), forward_ned.x());
}

// Asks for one goal after the other. A newer one that comes meanwhile waits for the answer only, not for the flight.
void Gateway::fly_to_goals() {
  while (true) {
    Goal goal;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return ending_ || goal_.has_value(); });
      if (ending_) return;
      goal = *std::exchange(goal_, std::nullopt);
    }
    const ground::ActionHandle action =
        vehicle_.go_to({goal.position_ned_m, goal.yaw_rad, settings_.goal_speed_m_s});
    const ground::Result answer = action.answer();
    const Eigen::Vector3d& at = goal.position_ned_m;
    if (answer.accepted()) {
      runtime::log_info("{}: goal at {:.2f} {:.2f} {:.2f} m NED accepted", vehicle_.name(), at.x(), at.y(),
                        at.z());
    } else {
      runtime::log_warning("{}: goal refused: {}", vehicle_.name(), answer.reason);
    }
  }
}

}  // namespace swiftlet::ros

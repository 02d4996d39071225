#include "swiftlet/record/file/standard_messages.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/cdr_writer.hpp"
#include "swiftlet/services/dds/payload.hpp"

namespace swiftlet::record {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr const char* kPoseTopic = "pose";
constexpr const char* kOdometryTopic = "odometry";
constexpr const char* kPathTopic = "path";
constexpr const char* kReferenceTopic = "reference_pose";
constexpr const char* kImuTopic = "imu_flu";
constexpr const char* kBatteryTopic = "battery_state";
constexpr const char* kTransformTopic = "/tf";
constexpr std::int64_t kPathPeriod_ns = math::kSecond_ns;
constexpr std::int64_t kPathStep_ns = math::kSecond_ns / 10;
constexpr std::int64_t kPathLength_ns = 30 * math::kSecond_ns;

// The definitions of ROS 2's common_interfaces, without their comments.
#define SWIFTLET_SEPARATOR \
  "================================================================================\n"
#define SWIFTLET_HEADER                                                 \
  SWIFTLET_SEPARATOR                                                    \
  "MSG: std_msgs/Header\n"                                              \
  "builtin_interfaces/Time stamp\nstring frame_id\n" SWIFTLET_SEPARATOR \
  "MSG: builtin_interfaces/Time\n"                                      \
  "int32 sec\nuint32 nanosec\n"
#define SWIFTLET_VECTOR3 SWIFTLET_SEPARATOR "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
#define SWIFTLET_QUATERNION \
  SWIFTLET_SEPARATOR "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
#define SWIFTLET_POSE                                                                       \
  SWIFTLET_SEPARATOR                                                                        \
  "MSG: geometry_msgs/Pose\n"                                                               \
  "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" SWIFTLET_SEPARATOR \
  "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" SWIFTLET_QUATERNION

constexpr messages::MessageSchema kPoseStamped{
    "geometry_msgs/msg/PoseStamped",
    "std_msgs/Header header\ngeometry_msgs/Pose pose\n" SWIFTLET_HEADER SWIFTLET_POSE, -1};
constexpr messages::MessageSchema kPath{
    "nav_msgs/msg/Path",
    "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n" SWIFTLET_HEADER SWIFTLET_SEPARATOR
    "MSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n" SWIFTLET_POSE,
    -1};
constexpr messages::MessageSchema kOdometry{
    "nav_msgs/msg/Odometry",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
    "geometry_msgs/TwistWithCovariance twist\n" SWIFTLET_HEADER SWIFTLET_SEPARATOR
    "MSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance\n" SWIFTLET_POSE
        SWIFTLET_SEPARATOR
    "MSG: geometry_msgs/TwistWithCovariance\ngeometry_msgs/Twist twist\nfloat64[36] "
    "covariance\n" SWIFTLET_SEPARATOR
    "MSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 "
    "angular\n" SWIFTLET_VECTOR3,
    -1};
constexpr messages::MessageSchema kTransforms{
    "tf2_msgs/msg/TFMessage",
    "geometry_msgs/TransformStamped[] transforms\n" SWIFTLET_SEPARATOR
    "MSG: geometry_msgs/TransformStamped\n"
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n" SWIFTLET_HEADER
        SWIFTLET_SEPARATOR
    "MSG: geometry_msgs/Transform\n"
    "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n" SWIFTLET_VECTOR3
        SWIFTLET_QUATERNION,
    -1};
constexpr messages::MessageSchema kImu{
    "sensor_msgs/msg/Imu",
    "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
    "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
    "geometry_msgs/Vector3 linear_acceleration\n"
    "float64[9] linear_acceleration_covariance\n" SWIFTLET_HEADER SWIFTLET_VECTOR3 SWIFTLET_QUATERNION,
    -1};
constexpr messages::MessageSchema kBatteryState{
    "sensor_msgs/msg/BatteryState",
    "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 charge\n"
    "float32 capacity\nfloat32 design_capacity\nfloat32 percentage\nuint8 power_supply_status\n"
    "uint8 power_supply_health\nuint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\n"
    "float32[] cell_temperature\nstring location\nstring serial_number\n" SWIFTLET_HEADER,
    -1};

void put_header(CdrWriter& out, std::int64_t time_ns, const std::string& frame) {
  out.put(static_cast<std::int32_t>(time_ns / math::kSecond_ns))
      .put(static_cast<std::uint32_t>(time_ns % math::kSecond_ns));
  out.text(frame);
}
void put_vector(CdrWriter& out, const Vector3d& v) { out.put(v.x()).put(v.y()).put(v.z()); }
void put_quaternion(CdrWriter& out, const Quaterniond& q) { out.put(q.x()).put(q.y()).put(q.z()).put(q.w()); }
// The first element says it, as sensor_msgs/Imu has it.
constexpr double kNoOrientation = -1.0;
constexpr double kUnknown = 0.0;
void put_covariance(CdrWriter& out, double first) {
  constexpr int kOthers = 8;
  out.put(first);
  for (int i = 0; i < kOthers; ++i) out.put(0.0);
}

// The covariance of six independent quantities: their variances on the diagonal of a matrix of 6 x 6.
void put_variances(CdrWriter& out, const std::array<double, 6>& variances) {
  for (std::size_t row = 0; row < variances.size(); ++row) {
    for (std::size_t column = 0; column < variances.size(); ++column)
      out.put(row == column ? variances[row] : 0.0);
  }
}

Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
Quaterniond quaternion(const std::array<double, 4>& q) { return {q[0], q[1], q[2], q[3]}; }

}  // namespace

Vector3d enu_from_ned(const Vector3d& v_ned) { return {v_ned.y(), v_ned.x(), -v_ned.z()}; }
Vector3d flu_from_frd(const Vector3d& v_frd) { return {v_frd.x(), -v_frd.y(), -v_frd.z()}; }
Quaterniond q_enu_from_flu(const Quaterniond& q_ned_from_frd) {
  // Half a turn about the axis between north and east, and half a turn about the forward axis.
  static const Quaterniond kEnuFromNed(0.0, std::sqrt(0.5), std::sqrt(0.5), 0.0);
  static const Quaterniond kFrdFromFlu(0.0, 1.0, 0.0, 0.0);
  return kEnuFromNed * q_ned_from_frd * kFrdFromFlu;
}

StandardMessages::StandardMessages(std::string vehicle) : vehicle_(vehicle), events_(std::move(vehicle)) {}

std::vector<StandardTopic> StandardMessages::ros_topics() const {
  const std::string estimate = messages::topics::kEstimate.name;
  return {{topic_of(kPoseTopic), &kPoseStamped, {estimate}},
          {topic_of(kOdometryTopic), &kOdometry, {estimate}},
          {topic_of(kPathTopic), &kPath, {estimate}},
          {kTransformTopic, &kTransforms, {estimate}},
          {topic_of(kReferenceTopic), &kPoseStamped, {messages::topics::kReference.name}},
          {topic_of(kImuTopic), &kImu, {messages::topics::kImu.name}},
          {topic_of(kBatteryTopic), &kBatteryState, {messages::topics::kBattery.name}}};
}

std::vector<StandardTopic> StandardMessages::topics() const {
  std::vector<StandardTopic> topics = ros_topics();
  topics.push_back(events_.topic());
  return topics;
}

std::vector<StandardMessage> StandardMessages::of(const std::string& topic, const mcap::Message& message) {
  if (topic == messages::topics::kEstimate.name) return of_estimate(message);
  if (topic == messages::topics::kReference.name) return of_reference(message);
  if (topic == messages::topics::kImu.name) return of_imu(message);
  if (topic == messages::topics::kBattery.name) return of_battery(message);
  return events_.of(topic, message);
}

StandardMessage StandardMessages::named(const char* name, const messages::MessageSchema& schema,
                                        mcap::Bytes payload) const {
  return {topic_of(name), &schema, std::move(payload)};
}

StandardMessage StandardMessages::pose_message(const char* name, const Pose& pose) const {
  CdrWriter out;
  put_header(out, pose.time_ns, kMapFrame);
  put_vector(out, pose.position_enu);
  put_quaternion(out, pose.q_enu_from_flu);
  return named(name, kPoseStamped, out.take());
}

StandardMessage StandardMessages::transform_message(const Pose& pose) const {
  CdrWriter out;
  out.put(std::uint32_t{1});
  put_header(out, pose.time_ns, kMapFrame);
  out.text(vehicle_);
  put_vector(out, pose.position_enu);
  put_quaternion(out, pose.q_enu_from_flu);
  return {kTransformTopic, &kTransforms, out.take()};
}

// The pose in the map, the velocity in the vehicle's frame, as ROS has it.
StandardMessage StandardMessages::odometry_message(const Pose& pose,
                                                   const messages::msg::Estimate& estimate) const {
  const auto variance = [&estimate](std::size_t state) {
    const double deviation = estimate.standard_deviation()[state];
    return deviation * deviation;
  };
  const Vector3d velocity_flu =
      pose.q_enu_from_flu.conjugate() * enu_from_ned(vector(estimate.velocity_ned()));
  // States: NED position 0 to 2, velocity 3 to 5, rotation 6 to 8, gyro bias 9 to 11. Those of the velocity are the
  // mean of the three axes, whatever the attitude.
  const double velocity_variance = (variance(3) + variance(4) + variance(5)) / 3.0;
  CdrWriter out;
  put_header(out, pose.time_ns, kMapFrame);
  out.text(vehicle_);
  put_vector(out, pose.position_enu);
  put_quaternion(out, pose.q_enu_from_flu);
  put_variances(out, {variance(1), variance(0), variance(2), variance(7), variance(6), variance(8)});
  put_vector(out, velocity_flu);
  put_vector(out, flu_from_frd(vector(estimate.body_rates_frd())));
  put_variances(out, {velocity_variance, velocity_variance, velocity_variance, variance(9), variance(10),
                      variance(11)});
  return named(kOdometryTopic, kOdometry, out.take());
}

StandardMessage StandardMessages::path_message(std::int64_t time_ns) const {
  CdrWriter out;
  put_header(out, time_ns, kMapFrame);
  out.put(static_cast<std::uint32_t>(path_.size()));
  for (const Pose& pose : path_) {
    put_header(out, pose.time_ns, kMapFrame);
    put_vector(out, pose.position_enu);
    put_quaternion(out, pose.q_enu_from_flu);
  }
  return named(kPathTopic, kPath, out.take());
}

std::vector<StandardMessage> StandardMessages::of_estimate(const mcap::Message& message) {
  messages::msg::Estimate estimate;
  if (!dds::from_payload(message.payload.data, message.payload.size, estimate)) return {};
  const std::int64_t time_ns = message.log_time_ns;
  const Pose pose{time_ns, enu_from_ned(vector(estimate.position_ned())),
                  q_enu_from_flu(quaternion(estimate.q_ned_from_frd()))};
  std::vector<StandardMessage> messages = {pose_message(kPoseTopic, pose), transform_message(pose),
                                           odometry_message(pose, estimate)};
  if (path_.empty() || time_ns - path_.back().time_ns >= kPathStep_ns) path_.push_back(pose);
  while (time_ns - path_.front().time_ns > kPathLength_ns) path_.pop_front();
  if (time_ns - path_sent_ns_ >= kPathPeriod_ns) {
    path_sent_ns_ = time_ns;
    messages.push_back(path_message(time_ns));
  }
  return messages;
}

std::vector<StandardMessage> StandardMessages::of_reference(const mcap::Message& message) const {
  messages::msg::Reference reference;
  if (!dds::from_payload(message.payload.data, message.payload.size, reference)) return {};
  return {pose_message(kReferenceTopic, {message.log_time_ns, enu_from_ned(vector(reference.position_ned())),
                                         q_enu_from_flu(quaternion(reference.attitude_setpoint()))})};
}

std::vector<StandardMessage> StandardMessages::of_imu(const mcap::Message& message) const {
  messages::msg::Imu imu;
  if (!dds::from_payload(message.payload.data, message.payload.size, imu)) return {};
  CdrWriter out;
  put_header(out, message.log_time_ns, vehicle_);
  put_quaternion(out, Quaterniond::Identity());
  put_covariance(out, kNoOrientation);  // an IMU measures no orientation
  put_vector(out, flu_from_frd(vector(imu.body_rates_frd())));
  put_covariance(out, kUnknown);
  put_vector(out, flu_from_frd(vector(imu.specific_force_frd())));
  put_covariance(out, kUnknown);
  return {named(kImuTopic, kImu, out.take())};
}

std::vector<StandardMessage> StandardMessages::of_battery(const mcap::Message& message) const {
  messages::msg::Battery battery;
  if (!dds::from_payload(message.payload.data, message.payload.size, battery)) return {};
  constexpr float kUnmeasured = std::numeric_limits<float>::quiet_NaN();
  constexpr std::uint8_t kDischarging = 2;
  constexpr std::uint8_t kUnknownHealth = 0;
  constexpr std::uint8_t kLithiumPolymer = 3;
  CdrWriter out;
  put_header(out, message.log_time_ns, vehicle_);
  out.put(static_cast<float>(battery.voltage_v())).put(kUnmeasured);  // temperature
  out.put(static_cast<float>(-battery.current_a()));                  // negative: it discharges
  out.put(kUnmeasured).put(kUnmeasured).put(kUnmeasured);             // charge, capacities
  out.put(static_cast<float>(battery.state_of_charge()));
  out.put(kDischarging).put(kUnknownHealth).put(kLithiumPolymer).put(std::uint8_t{1});
  out.put(std::uint32_t{0}).put(std::uint32_t{0}).text("").text("");  // cells, location, serial number
  return {named(kBatteryTopic, kBatteryState, out.take())};
}

}  // namespace swiftlet::record

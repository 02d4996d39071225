#include "swiftlet/services/px4/px4_topics.hpp"

#include "px4_msgs/msg/BatteryStatusPubSubTypes.h"
#include "px4_msgs/msg/FailsafeFlagsPubSubTypes.h"
#include "px4_msgs/msg/OffboardControlModePubSubTypes.h"
#include "px4_msgs/msg/SensorCombinedPubSubTypes.h"
#include "px4_msgs/msg/TrajectorySetpointPubSubTypes.h"
#include "px4_msgs/msg/VehicleAttitudeSetpointPubSubTypes.h"
#include "px4_msgs/msg/VehicleCommandAckPubSubTypes.h"
#include "px4_msgs/msg/VehicleCommandPubSubTypes.h"
#include "px4_msgs/msg/VehicleLandDetectedPubSubTypes.h"
#include "px4_msgs/msg/VehicleOdometryPubSubTypes.h"
#include "px4_msgs/msg/VehicleRatesSetpointPubSubTypes.h"
#include "px4_msgs/msg/VehicleStatusPubSubTypes.h"

#include "swiftlet/services/dds/endpoints.hpp"

// clang-format off
#define SWIFTLET_FOR_EACH_MESSAGE(X)                                                                   \
  X(BatteryStatus) X(FailsafeFlags) X(OffboardControlMode) X(SensorCombined) X(TrajectorySetpoint)     \
  X(VehicleAttitudeSetpoint) X(VehicleCommand) X(VehicleCommandAck) X(VehicleLandDetected)             \
  X(VehicleOdometry) X(VehicleRatesSetpoint) X(VehicleStatus)
// clang-format on

namespace swiftlet::dds {

#define SWIFTLET_INSTANTIATE(Name)                                                                           \
  template <>                                                                                                \
  struct PubSubTypeOf<px4::msg::Name> {                                                                      \
    using type = px4::msg::Name##PubSubType;                                                                 \
  };                                                                                                         \
  template dds::Publisher<px4::msg::Name> dds::Node::publish(const messages::Topic<px4::msg::Name>&);        \
  template dds::Subscription dds::Node::subscribe(const messages::Topic<px4::msg::Name>&,                    \
                                                  std::function<void(const px4::msg::Name&)>, dds::Delivery, \
                                                  std::optional<dds::OneSource>);
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_INSTANTIATE)
#undef SWIFTLET_INSTANTIATE

}  // namespace swiftlet::dds

namespace swiftlet::px4 {

std::string topic_folder(int instance, const std::string& prefix) {
  if (prefix.empty()) return instance == 0 ? "/fmu" : topic_folder(instance, "px4_");
  return "/" + prefix + std::to_string(instance) + "/fmu";
}

}  // namespace swiftlet::px4

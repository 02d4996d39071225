#include "swiftlet/services/control/vehicle_sample.hpp"

#include <limits>

#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::services {
namespace {

template <class Sample, class Message>
VehicleSample converted(const Message& message) {
  Sample sample;
  if (messages::from_message(message, sample)) {
    sample.stamp_ns = message.stamp_ns();
    sample.sequence = message.sequence_number();
    sample.body_rates_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return {sample, messages::from_message(message.obeyed()), messages::from_message(message.lockstep())};
}

}  // namespace

VehicleSample vehicle_sample(const messages::msg::Imu& message) {
  return converted<plant::ImuSample>(message);
}

VehicleSample vehicle_sample(const messages::msg::VehicleOdometry& message) {
  return converted<plant::OdometrySample>(message);
}

}  // namespace swiftlet::services

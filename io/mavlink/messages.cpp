#include "swiftlet/io/mavlink/messages.hpp"

namespace swiftlet::mavlink {

std::optional<std::uint8_t> crc_extra_of(std::uint32_t message_id) {
  switch (message_id) {
    case Heartbeat::kId:
      return Heartbeat::kCrcExtra;
    case SystemTime::kId:
      return SystemTime::kCrcExtra;
    case ParamRequestRead::kId:
      return ParamRequestRead::kCrcExtra;
    case ParamValue::kId:
      return ParamValue::kCrcExtra;
    case ParamSet::kId:
      return ParamSet::kCrcExtra;
    case CommandLong::kId:
      return CommandLong::kCrcExtra;
    case HilActuatorControls::kId:
      return HilActuatorControls::kCrcExtra;
    case HilSensor::kId:
      return HilSensor::kCrcExtra;
    case HilGps::kId:
      return HilGps::kCrcExtra;
    case HilStateQuaternion::kId:
      return HilStateQuaternion::kCrcExtra;
    default:
      return std::nullopt;
  }
}

}  // namespace swiftlet::mavlink

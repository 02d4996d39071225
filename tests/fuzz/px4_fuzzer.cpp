// Fuzzes the messages of PX4, from bytes to samples and words. The first byte selects the type.
#include <cmath>
#include <cstring>

#include <spdlog/spdlog.h>

#include "px4_msgs/msg/BatteryStatusPubSubTypes.h"
#include "px4_msgs/msg/FailsafeFlagsPubSubTypes.h"
#include "px4_msgs/msg/SensorCombinedPubSubTypes.h"
#include "px4_msgs/msg/VehicleCommandAckPubSubTypes.h"
#include "px4_msgs/msg/VehicleLandDetectedPubSubTypes.h"
#include "px4_msgs/msg/VehicleOdometryPubSubTypes.h"
#include "px4_msgs/msg/VehicleStatusPubSubTypes.h"

#include "swiftlet/services/dds/checked_type_support.hpp"
#include "swiftlet/services/px4/offboard_session.hpp"
#include "swiftlet/services/px4/translate.hpp"
#include "swiftlet/services/px4/words.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/support/serialization.hpp"

using namespace swiftlet;

namespace {

template <class PubSubType, class Use>
void use(const std::uint8_t* data, std::size_t size, const Use& what) {
  static swiftlet::dds::CheckedTypeSupport<PubSubType> type;
  swiftlet::dds::ReceivedSample<typename PubSubType::type> sample;
  if (tests::deserialize(type, data, size, &sample)) what(sample.message);
}

void demand_reason(const messages::Fault& fault) {
  if (fault) tests::demand(std::strlen(fault.text) > 8, "a refusal says what is wrong");
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  spdlog::set_level(spdlog::level::off);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::uint8_t* const payload = data + 1;
  const std::size_t length = size - 1;
  switch (*data) {
    case 0:
      use<px4::msg::SensorCombinedPubSubType>(payload, length, [](const auto& message) {
        plant::ImuSample sample;
        const messages::Fault fault = px4::from_px4(message, sample);
        demand_reason(fault);
        tests::demand(sample.specific_force_frd.allFinite() && sample.body_rates_frd.allFinite(),
                      "a sample is finite");
      });
      break;
    case 1:
      use<px4::msg::BatteryStatusPubSubType>(payload, length, [](const auto& message) {
        plant::BatterySample sample;
        demand_reason(px4::from_px4(message, sample));
        tests::demand(sample.voltage_v >= 0.0 && std::isfinite(sample.current_a) &&
                          sample.state_of_charge >= 0.0 && sample.state_of_charge <= 1.0,
                      "a battery is within its limits");
      });
      break;
    case 2:
      use<px4::msg::VehicleOdometryPubSubType>(payload, length, [](const auto& message) {
        plant::OdometrySample odometry;
        demand_reason(px4::from_px4(message, odometry));
        plant::OdometrySample again;
        tests::demand(!messages::from_message(messages::to_message(odometry), again),
                      "an estimate can be sent");
      });
      break;
    case 3:
      use<px4::msg::VehicleStatusPubSubType>(payload, length, [](const auto& message) {
        const messages::Fault fault = px4::check(message);
        demand_reason(fault);
        tests::demand(!px4::mode_name(message.nav_state()).empty() &&
                          !px4::disarming_reason(message.latest_disarming_reason()).empty(),
                      "every state has a name");
        if (fault) return;
        px4::OffboardSession session;
        px4::OffboardInputs inputs;
        inputs.now_ns = inputs.status_ns = inputs.sampled_ns = inputs.commanded_ns = 1'000'000'000;
        inputs.status = message;
        inputs.rotors_wanted = true;
        for (int i = 0; i < 5; ++i) session.update(inputs);
      });
      break;
    case 4:
      use<px4::msg::FailsafeFlagsPubSubType>(payload, length, [](const auto& message) {
        tests::demand(px4::failing_checks(message).size() < 500, "a list of checks is bounded");
      });
      break;
    case 5:
      use<px4::msg::VehicleCommandAckPubSubType>(payload, length, [](const auto& message) {
        px4::OffboardSession session;
        session.on_ack(message);
        tests::demand(!px4::result_text(message.result()).empty(), "every result has a name");
      });
      break;
    case 6:
      use<px4::msg::VehicleLandDetectedPubSubType>(payload, length, [](const auto&) {});
      break;
    default:
      break;
  }
  return 0;
}

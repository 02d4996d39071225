// Fuzzes received messages, from bytes to the structs for the controller. The first byte selects the type.
#include <cstring>

#include <spdlog/spdlog.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/services/dds/checked_type_support.hpp"
#include "swiftlet/services/dds/message_types.hpp"
#include "tests/fuzz/message_types.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/support/serialization.hpp"

using namespace swiftlet;

namespace {

// Converts the bytes to the plain struct of a message; false if they are not a valid message.
template <class Type>
bool is_accepted(const std::uint8_t* data, std::size_t size, typename Type::Plain& out) {
  static swiftlet::dds::CheckedTypeSupport<typename swiftlet::dds::PubSubTypeOf<typename Type::Message>::type>
      type;
  swiftlet::dds::ReceivedSample<typename Type::Message> sample;
  if (!tests::deserialize(type, data, size, &sample)) return false;
  const messages::Fault fault = messages::from_message(sample.message, out);
  if (fault) tests::demand(std::strlen(fault.text) > 8, "a refusal says what is wrong");
  return !fault;
}

template <class Type>
void check_message(const std::uint8_t* data, std::size_t size) {
  using Message = typename Type::Message;
  typename Type::Plain accepted;
  if (!is_accepted<Type>(data, size, accepted)) return;
  if constexpr (std::is_same_v<Message, messages::msg::Mission> ||
                std::is_same_v<Message, messages::msg::Trajectory>) {
    const control::Outcome outcome = control::check(accepted, control::Limits());
    tests::demand(outcome.accepted || std::strlen(outcome.reason) > 8, "a refusal says what is wrong");
  } else if constexpr (!std::is_same_v<Message, messages::msg::GroundLink>) {
    typename Type::Plain again;
    tests::demand(!messages::from_message(messages::to_message(accepted), again),
                  "an accepted message can be sent");
  }
}

template <class... Types>
void check_selected(std::tuple<Types...>, char tag, const std::uint8_t* data, std::size_t size) {
  (void)((tag == Types::kTag && (check_message<Types>(data, size), true)) || ...);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  spdlog::set_level(spdlog::level::off);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  check_selected(tests::MessageTypes(), static_cast<char>(*data), data + 1, size - 1);
  return 0;
}

#include "swiftlet/io/mavlink/messages.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/mavlink/crc.hpp"
#include "swiftlet/io/mavlink/payload.hpp"
#include "swiftlet/math/random.hpp"

namespace swiftlet::mavlink::messages_test {

// A field of a definition in https://mavlink.io/en/messages/common.html.
struct Field {
  std::string type;
  std::string name;
  std::uint8_t count = 0;  // of an array
  bool extension = false;

  std::size_t element_size() const {
    if (type == "uint64_t") return 8;
    if (type == "uint32_t" || type == "int32_t" || type == "float") return 4;
    return type == "uint16_t" || type == "int16_t" ? 2 : 1;
  }
  bool operator==(const Field& o) const {
    return type == o.type && name == o.name && count == o.count && extension == o.extension;
  }
};

struct Definition {
  std::string name;
  std::vector<Field> fields;  // in the order of the definition
};

const Definition kHeartbeat{"HEARTBEAT",
                            {{"uint8_t", "type"},
                             {"uint8_t", "autopilot"},
                             {"uint8_t", "base_mode"},
                             {"uint32_t", "custom_mode"},
                             {"uint8_t", "system_status"},
                             {"uint8_t", "mavlink_version"}}};
const Definition kSystemTime{"SYSTEM_TIME", {{"uint64_t", "time_unix_usec"}, {"uint32_t", "time_boot_ms"}}};
const Definition kParamRequestRead{"PARAM_REQUEST_READ",
                                   {{"uint8_t", "target_system"},
                                    {"uint8_t", "target_component"},
                                    {"char", "param_id", 16},
                                    {"int16_t", "param_index"}}};
const Definition kParamValue{"PARAM_VALUE",
                             {{"char", "param_id", 16},
                              {"float", "param_value"},
                              {"uint8_t", "param_type"},
                              {"uint16_t", "param_count"},
                              {"uint16_t", "param_index"}}};
const Definition kParamSet{"PARAM_SET",
                           {{"uint8_t", "target_system"},
                            {"uint8_t", "target_component"},
                            {"char", "param_id", 16},
                            {"float", "param_value"},
                            {"uint8_t", "param_type"}}};
const Definition kCommandLong{"COMMAND_LONG",
                              {{"uint8_t", "target_system"},
                               {"uint8_t", "target_component"},
                               {"uint16_t", "command"},
                               {"uint8_t", "confirmation"},
                               {"float", "param1"},
                               {"float", "param2"},
                               {"float", "param3"},
                               {"float", "param4"},
                               {"float", "param5"},
                               {"float", "param6"},
                               {"float", "param7"}}};
const Definition kHilActuatorControls{
    "HIL_ACTUATOR_CONTROLS",
    {{"uint64_t", "time_usec"}, {"float", "controls", 16}, {"uint8_t", "mode"}, {"uint64_t", "flags"}}};
const Definition kHilSensor{"HIL_SENSOR",
                            {{"uint64_t", "time_usec"},
                             {"float", "xacc"},
                             {"float", "yacc"},
                             {"float", "zacc"},
                             {"float", "xgyro"},
                             {"float", "ygyro"},
                             {"float", "zgyro"},
                             {"float", "xmag"},
                             {"float", "ymag"},
                             {"float", "zmag"},
                             {"float", "abs_pressure"},
                             {"float", "diff_pressure"},
                             {"float", "pressure_alt"},
                             {"float", "temperature"},
                             {"uint32_t", "fields_updated"},
                             {"uint8_t", "id", 0, true}}};
const Definition kHilGps{"HIL_GPS",
                         {{"uint64_t", "time_usec"},
                          {"uint8_t", "fix_type"},
                          {"int32_t", "lat"},
                          {"int32_t", "lon"},
                          {"int32_t", "alt"},
                          {"uint16_t", "eph"},
                          {"uint16_t", "epv"},
                          {"uint16_t", "vel"},
                          {"int16_t", "vn"},
                          {"int16_t", "ve"},
                          {"int16_t", "vd"},
                          {"uint16_t", "cog"},
                          {"uint8_t", "satellites_visible"},
                          {"uint8_t", "id", 0, true},
                          {"uint16_t", "yaw", 0, true}}};
const Definition kHilStateQuaternion{"HIL_STATE_QUATERNION",
                                     {{"uint64_t", "time_usec"},
                                      {"float", "attitude_quaternion", 4},
                                      {"float", "rollspeed"},
                                      {"float", "pitchspeed"},
                                      {"float", "yawspeed"},
                                      {"int32_t", "lat"},
                                      {"int32_t", "lon"},
                                      {"int32_t", "alt"},
                                      {"int16_t", "vx"},
                                      {"int16_t", "vy"},
                                      {"int16_t", "vz"},
                                      {"uint16_t", "ind_airspeed"},
                                      {"uint16_t", "true_airspeed"},
                                      {"int16_t", "xacc"},
                                      {"int16_t", "yacc"},
                                      {"int16_t", "zacc"}}};

// By size of the element, largest first, but extensions stay where they are.
std::vector<Field> in_wire_order(std::vector<Field> fields) {
  const auto extensions =
      std::find_if(fields.begin(), fields.end(), [](const Field& f) { return f.extension; });
  std::stable_sort(fields.begin(), extensions,
                   [](const Field& a, const Field& b) { return a.element_size() > b.element_size(); });
  return fields;
}

// https://mavlink.io/en/guide/serialization.html#crc_extra
std::uint8_t checksum_of(const Definition& definition) {
  Crc crc;
  const auto add = [&](const std::string& text) {
    crc.add(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  add(definition.name + " ");
  for (const Field& field : in_wire_order(definition.fields)) {
    if (field.extension) continue;
    add(field.type + " " + field.name + " ");
    if (field.count > 0) crc.add(field.count);
  }
  return static_cast<std::uint8_t>((crc.value() & 0xffU) ^ (crc.value() >> 8U));
}

const char* type_name(float) { return "float"; }
const char* type_name(std::uint64_t) { return "uint64_t"; }
const char* type_name(std::uint32_t) { return "uint32_t"; }
const char* type_name(std::int32_t) { return "int32_t"; }
const char* type_name(std::uint16_t) { return "uint16_t"; }
const char* type_name(std::int16_t) { return "int16_t"; }
const char* type_name(std::uint8_t) { return "uint8_t"; }
const char* type_name(char) { return "char"; }

// Collects what visit() calls, with elements of a definition's array that are separate fields as they are.
struct Collector {
  std::vector<Field> fields;
  bool in_extensions = false;

  void extensions() { in_extensions = true; }
  template <class Value>
  void operator()(const char* name, Value value) {
    fields.push_back({type_name(value), name, 0, in_extensions});
  }
  template <class Value, std::size_t Count>
  void operator()(const char* name, const std::array<Value, Count>&) {
    fields.push_back({type_name(Value{}), name, static_cast<std::uint8_t>(Count), in_extensions});
  }
};

template <class Message>
void expect_as_defined(const Definition& definition) {
  EXPECT_EQ(Message::kName, definition.name);
  EXPECT_EQ(Message::kCrcExtra, checksum_of(definition)) << definition.name;
  EXPECT_EQ(crc_extra_of(Message::kId), Message::kCrcExtra);
  Collector collector;
  Message message;
  Message::visit(collector, message);
  EXPECT_EQ(collector.fields, in_wire_order(definition.fields)) << definition.name;
}

TEST(MavlinkMessages, HaveTheFieldsAndChecksumsOfTheirDefinitions) {
  expect_as_defined<Heartbeat>(kHeartbeat);
  expect_as_defined<SystemTime>(kSystemTime);
  expect_as_defined<ParamRequestRead>(kParamRequestRead);
  expect_as_defined<ParamValue>(kParamValue);
  expect_as_defined<ParamSet>(kParamSet);
  expect_as_defined<CommandLong>(kCommandLong);
  expect_as_defined<HilActuatorControls>(kHilActuatorControls);
  expect_as_defined<HilSensor>(kHilSensor);
  expect_as_defined<HilGps>(kHilGps);
  expect_as_defined<HilStateQuaternion>(kHilStateQuaternion);
  EXPECT_EQ(crc_extra_of(30), std::nullopt);
}

// Sets each field to a number from a random stream, and compares two messages by drawing the same numbers again.
struct Randomiser {
  math::RandomStream random{11, 3};
  bool compare = false;
  bool equal = true;

  void extensions() {}
  template <class Value>
  void operator()(const char*, Value& value) {
    const auto drawn = static_cast<Value>(static_cast<std::int16_t>(random.next()));
    if (!compare) value = drawn;
    if (value != drawn) equal = false;
  }
  template <class Value, std::size_t Count>
  void operator()(const char* name, std::array<Value, Count>& values) {
    for (Value& value : values) (*this)(name, value);
  }
};

template <class Message>
bool survives_a_round_trip() {
  Message message;
  Randomiser write;
  Message::visit(write, message);
  Message back = from_frame<Message>(to_frame(message, {1, 1}, 0));
  Randomiser check;
  check.compare = true;
  Message::visit(check, back);
  return check.equal;
}

TEST(MavlinkMessages, SurviveARoundTrip) {
  EXPECT_TRUE(survives_a_round_trip<Heartbeat>());
  EXPECT_TRUE(survives_a_round_trip<SystemTime>());
  EXPECT_TRUE(survives_a_round_trip<ParamRequestRead>());
  EXPECT_TRUE(survives_a_round_trip<ParamValue>());
  EXPECT_TRUE(survives_a_round_trip<ParamSet>());
  EXPECT_TRUE(survives_a_round_trip<CommandLong>());
  EXPECT_TRUE(survives_a_round_trip<HilActuatorControls>());
  EXPECT_TRUE(survives_a_round_trip<HilSensor>());
  EXPECT_TRUE(survives_a_round_trip<HilGps>());
  EXPECT_TRUE(survives_a_round_trip<HilStateQuaternion>());
}

}  // namespace swiftlet::mavlink::messages_test

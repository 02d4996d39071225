// The messages of a simulator and an autopilot, and those of an autopilot's parameters, with the units of
// https://mavlink.io/en/messages/common.html.
//
// visit() calls visitor(name, field) for each field in the order of the wire: by size, largest first, then as in
// the definition. Extensions follow in the order of the definition, after visitor.extensions(). kCrcExtra is the
// checksum of the definition.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace swiftlet::mavlink {

struct Heartbeat {
  static constexpr const char* kName = "HEARTBEAT";
  static constexpr std::uint32_t kId = 0;
  static constexpr std::uint8_t kCrcExtra = 50;
  static constexpr std::uint8_t kArmed = 128;      // of base_mode
  static constexpr std::uint8_t kNoAutopilot = 8;  // autopilot of a component that is none
  static constexpr std::uint8_t kStateActive = 4;

  std::uint32_t custom_mode = 0;
  std::uint8_t type = 0;  // 0: generic
  std::uint8_t autopilot = kNoAutopilot;
  std::uint8_t base_mode = 0;
  std::uint8_t system_status = kStateActive;
  std::uint8_t mavlink_version = 3;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("custom_mode", m.custom_mode);
    visitor("type", m.type);
    visitor("autopilot", m.autopilot);
    visitor("base_mode", m.base_mode);
    visitor("system_status", m.system_status);
    visitor("mavlink_version", m.mavlink_version);
  }
};

struct SystemTime {
  static constexpr const char* kName = "SYSTEM_TIME";
  static constexpr std::uint32_t kId = 2;
  static constexpr std::uint8_t kCrcExtra = 137;

  std::uint64_t time_unix_usec = 0;
  std::uint32_t time_boot_ms = 0;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("time_unix_usec", m.time_unix_usec);
    visitor("time_boot_ms", m.time_boot_ms);
  }
};

// Types in PARAM_SET and PARAM_VALUE: whole numbers and reals of 32 bits. PX4 puts the bytes of a whole number into the
// float.
constexpr std::uint8_t kParamInt32 = 6;
constexpr std::uint8_t kParamReal32 = 9;
using ParamId = std::array<char, 16>;  // ends with NUL, unless it has 16 letters

struct ParamRequestRead {
  static constexpr const char* kName = "PARAM_REQUEST_READ";
  static constexpr std::uint32_t kId = 20;
  static constexpr std::uint8_t kCrcExtra = 214;

  std::int16_t param_index = -1;  // -1: by its name
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  ParamId param_id{};

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("param_index", m.param_index);
    visitor("target_system", m.target_system);
    visitor("target_component", m.target_component);
    visitor("param_id", m.param_id);
  }
};

struct ParamValue {
  static constexpr const char* kName = "PARAM_VALUE";
  static constexpr std::uint32_t kId = 22;
  static constexpr std::uint8_t kCrcExtra = 220;

  float param_value = 0.0F;
  std::uint16_t param_count = 0;
  std::uint16_t param_index = 0;
  ParamId param_id{};
  std::uint8_t param_type = 0;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("param_value", m.param_value);
    visitor("param_count", m.param_count);
    visitor("param_index", m.param_index);
    visitor("param_id", m.param_id);
    visitor("param_type", m.param_type);
  }
};

struct ParamSet {
  static constexpr const char* kName = "PARAM_SET";
  static constexpr std::uint32_t kId = 23;
  static constexpr std::uint8_t kCrcExtra = 168;

  float param_value = 0.0F;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  ParamId param_id{};
  std::uint8_t param_type = 0;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("param_value", m.param_value);
    visitor("target_system", m.target_system);
    visitor("target_component", m.target_component);
    visitor("param_id", m.param_id);
    visitor("param_type", m.param_type);
  }
};

struct CommandLong {
  static constexpr const char* kName = "COMMAND_LONG";
  static constexpr std::uint32_t kId = 76;
  static constexpr std::uint8_t kCrcExtra = 152;
  // param1: id of a message; param2: interval, us, -1: not at all, 0: at the sender's choice.
  static constexpr std::uint16_t kSetMessageInterval = 511;

  std::array<float, 7> params{};
  std::uint16_t command = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t confirmation = 0;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("param1", m.params[0]);
    visitor("param2", m.params[1]);
    visitor("param3", m.params[2]);
    visitor("param4", m.params[3]);
    visitor("param5", m.params[4]);
    visitor("param6", m.params[5]);
    visitor("param7", m.params[6]);
    visitor("command", m.command);
    visitor("target_system", m.target_system);
    visitor("target_component", m.target_component);
    visitor("confirmation", m.confirmation);
  }
};

struct HilActuatorControls {
  static constexpr const char* kName = "HIL_ACTUATOR_CONTROLS";
  static constexpr std::uint32_t kId = 93;
  static constexpr std::uint8_t kCrcExtra = 47;
  static constexpr std::uint64_t kLockstep = 1;  // of flags
  static constexpr std::uint8_t kArmed = 128;    // of mode

  std::uint64_t time_usec = 0;
  std::uint64_t flags = 0;
  std::array<float, 16> controls{};  // -1 .. 1, motors 0 .. 1
  std::uint8_t mode = 0;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("time_usec", m.time_usec);
    visitor("flags", m.flags);
    visitor("controls", m.controls);
    visitor("mode", m.mode);
  }
};

struct HilSensor {
  static constexpr const char* kName = "HIL_SENSOR";
  static constexpr std::uint32_t kId = 107;
  static constexpr std::uint8_t kCrcExtra = 108;
  // Bits of fields_updated: the fields that hold a new measurement.
  static constexpr std::uint32_t kAccelerometer = 0x7;
  static constexpr std::uint32_t kGyro = 0x38;
  static constexpr std::uint32_t kMagnetometer = 0x1c0;
  static constexpr std::uint32_t kBarometer = 0x1a00;  // absolute pressure, pressure altitude, temperature

  std::uint64_t time_usec = 0;
  std::array<float, 3> acceleration{};  // m/s^2, specific force in FRD
  std::array<float, 3> gyro{};          // rad/s, FRD
  std::array<float, 3> mag{};           // gauss, FRD
  float abs_pressure = 0.0F;            // hPa
  float diff_pressure = 0.0F;           // hPa, of an airspeed sensor
  float pressure_alt = 0.0F;            // m, from abs_pressure
  float temperature = 0.0F;             // deg C
  std::uint32_t fields_updated = 0;
  std::uint8_t id = 0;

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("time_usec", m.time_usec);
    visitor("xacc", m.acceleration[0]);
    visitor("yacc", m.acceleration[1]);
    visitor("zacc", m.acceleration[2]);
    visitor("xgyro", m.gyro[0]);
    visitor("ygyro", m.gyro[1]);
    visitor("zgyro", m.gyro[2]);
    visitor("xmag", m.mag[0]);
    visitor("ymag", m.mag[1]);
    visitor("zmag", m.mag[2]);
    visitor("abs_pressure", m.abs_pressure);
    visitor("diff_pressure", m.diff_pressure);
    visitor("pressure_alt", m.pressure_alt);
    visitor("temperature", m.temperature);
    visitor("fields_updated", m.fields_updated);
    visitor.extensions();
    visitor("id", m.id);
  }
};

struct HilGps {
  static constexpr const char* kName = "HIL_GPS";
  static constexpr std::uint32_t kId = 113;
  static constexpr std::uint8_t kCrcExtra = 124;
  static constexpr std::uint8_t kFix3d = 3;
  static constexpr std::uint16_t kUnknown = 0xffff;  // of cog

  std::uint64_t time_usec = 0;
  std::int32_t lat = 0;  // 1e-7 deg
  std::int32_t lon = 0;
  std::int32_t alt = 0;   // mm above mean sea level
  std::uint16_t eph = 0;  // dilution of precision in 0.01, which PX4 takes for cm
  std::uint16_t epv = 0;
  std::uint16_t vel = 0;  // cm/s, over ground
  std::int16_t vn = 0;    // cm/s
  std::int16_t ve = 0;
  std::int16_t vd = 0;
  std::uint16_t cog = kUnknown;  // 0.01 deg, course over ground, 0 .. 35999
  std::uint8_t fix_type = 0;
  std::uint8_t satellites_visible = 0;
  std::uint8_t id = 0;
  std::uint16_t yaw = 0;  // 0.01 deg; 0: not available

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("time_usec", m.time_usec);
    visitor("lat", m.lat);
    visitor("lon", m.lon);
    visitor("alt", m.alt);
    visitor("eph", m.eph);
    visitor("epv", m.epv);
    visitor("vel", m.vel);
    visitor("vn", m.vn);
    visitor("ve", m.ve);
    visitor("vd", m.vd);
    visitor("cog", m.cog);
    visitor("fix_type", m.fix_type);
    visitor("satellites_visible", m.satellites_visible);
    visitor.extensions();
    visitor("id", m.id);
    visitor("yaw", m.yaw);
  }
};

struct HilStateQuaternion {
  static constexpr const char* kName = "HIL_STATE_QUATERNION";
  static constexpr std::uint32_t kId = 115;
  static constexpr std::uint8_t kCrcExtra = 4;

  std::uint64_t time_usec = 0;
  std::array<float, 4> attitude_quaternion{};  // w, x, y, z: from FRD to NED
  std::array<float, 3> body_rates{};           // rad/s
  std::int32_t lat = 0;                        // 1e-7 deg
  std::int32_t lon = 0;
  std::int32_t alt = 0;                        // mm
  std::array<std::int16_t, 3> velocity{};      // cm/s, NED
  std::uint16_t ind_airspeed = 0;              // cm/s
  std::uint16_t true_airspeed = 0;             // cm/s
  std::array<std::int16_t, 3> acceleration{};  // 0.001 of gravity

  template <class Visitor, class Self>
  static void visit(Visitor& visitor, Self& m) {
    visitor("time_usec", m.time_usec);
    visitor("attitude_quaternion", m.attitude_quaternion);
    visitor("rollspeed", m.body_rates[0]);
    visitor("pitchspeed", m.body_rates[1]);
    visitor("yawspeed", m.body_rates[2]);
    visitor("lat", m.lat);
    visitor("lon", m.lon);
    visitor("alt", m.alt);
    visitor("vx", m.velocity[0]);
    visitor("vy", m.velocity[1]);
    visitor("vz", m.velocity[2]);
    visitor("ind_airspeed", m.ind_airspeed);
    visitor("true_airspeed", m.true_airspeed);
    visitor("xacc", m.acceleration[0]);
    visitor("yacc", m.acceleration[1]);
    visitor("zacc", m.acceleration[2]);
  }
};

// The checksum of the definition of one of the messages above; empty for any other message.
std::optional<std::uint8_t> crc_extra_of(std::uint32_t message_id);

}  // namespace swiftlet::mavlink

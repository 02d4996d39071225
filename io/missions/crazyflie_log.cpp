#include "swiftlet/io/missions/crazyflie_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <zlib.h>

#include <Eigen/Core>
#include <fmt/core.h>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/math/angles.hpp"

namespace swiftlet::io {
namespace {

using io::ByteReader;
using io::ConfigError;

constexpr std::uint8_t kMagic = 0xBC;
constexpr std::size_t kHeaderBytes = 5;
constexpr std::size_t kCrcBytes = 4;
constexpr std::string_view kTypes = "bBhHiIqQefd";
constexpr std::array<std::size_t, 11> kBytes = {1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

struct Variable {
  std::string name;  // in lower case
  char type = 'f';
};

struct EventType {
  std::string name;
  std::vector<Variable> variables;
  std::size_t bytes = 0;  // of all variables

  std::optional<std::size_t> find(const std::string& wanted) const {
    const auto found = std::find_if(variables.begin(), variables.end(),
                                    [&](const Variable& variable) { return variable.name == wanted; });
    if (found == variables.end()) return std::nullopt;
    return static_cast<std::size_t>(found - variables.begin());
  }
};

struct Event {
  double time_s = 0.0;
  std::vector<double> values;  // of all variables
};

double value_of(ByteReader& reader, char type) {
  switch (type) {
    case 'b':
      return static_cast<std::int8_t>(reader.u8());
    case 'B':
      return reader.u8();
    case 'h':
      return static_cast<std::int16_t>(reader.u16());
    case 'H':
      return reader.u16();
    case 'i':
      return reader.i32();
    case 'I':
      return reader.u32();
    case 'q':
      return static_cast<double>(static_cast<std::int64_t>(reader.u64()));
    case 'Q':
      return static_cast<double>(reader.u64());
    case 'e':
      return Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(reader.u16()));
    case 'd':
      return reader.f64();
    default:
      return reader.f32();
  }
}

class CrazyflieReader {
 public:
  CrazyflieReader(std::string_view bytes, const std::string& file)
      : all_(bytes),
        file_(file),
        reader_(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), true) {}

  // The events of the first type that has the estimated position, and that type.
  std::pair<EventType, std::vector<Event>> read() {
    require_whole();
    reader_ = reader_.part(reader_.rest() - kCrcBytes);
    reader_.skip(1);
    version_ = reader_.u16();
    if (version_ != 1 && version_ != 2) fail(fmt::format("is of version {}, must be of 1 or 2", version_));
    read_types();
    const auto wanted = std::find_if(types_.begin(), types_.end(), [](const auto& type) {
      return type.second.find("stateestimate.x") && type.second.find("stateestimate.y") &&
             type.second.find("stateestimate.z");
    });
    if (wanted == types_.end())
      fail("has no event with stateEstimate.x, stateEstimate.y and stateEstimate.z; it has " + names());
    return {wanted->second, events_of(wanted->first)};
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw ConfigError(file_, 0, "", message); }

  void require_whole() const {
    if (all_.size() < kHeaderBytes + kCrcBytes)
      fail(fmt::format("has {} bytes, a log of the Crazyflie has at least {}", all_.size(),
                       kHeaderBytes + kCrcBytes));
    const auto* const data = reinterpret_cast<const unsigned char*>(all_.data());
    const std::size_t length = all_.size() - kCrcBytes;
    ByteReader end(data + length, kCrcBytes, true);
    if (crc32_z(0, data, length) != end.u32())
      fail(
          "is cut or damaged: the CRC-32 at its end is not that of its content; a log is complete once "
          "logging was "
          "stopped");
  }

  void read_types() {
    const std::uint16_t count = reader_.u16();
    for (int i = 0; i < count; ++i) {
      const std::uint16_t id = reader_.u16();
      EventType type;
      type.name = std::string(reader_.text());
      const std::uint16_t variables = reader_.u16();
      for (int k = 0; k < variables && reader_.ok(); ++k) add_variable(type, std::string(reader_.text()));
      if (!reader_.ok())
        fail(fmt::format("ends within the description of event type {} of {}", i + 1, count));
      if (!types_.emplace(id, std::move(type)).second) fail(fmt::format("has event type {} twice", id));
    }
  }

  // "stateEstimate.x(f)"
  void add_variable(EventType& type, const std::string& text) const {
    if (!reader_.ok()) return;
    const std::size_t size = text.size();
    const std::size_t known = size > 3 && text[size - 3] == '(' && text[size - 1] == ')'
                                  ? kTypes.find(text[size - 2])
                                  : std::string_view::npos;
    if (known == std::string_view::npos)
      fail(fmt::format("has the variable {}, must be a name and one of the types {} in brackets",
                       text.substr(0, 60), kTypes));
    type.bytes += kBytes[known];
    type.variables.push_back({lower(text.substr(0, size - 3)), text[size - 2]});
  }

  std::vector<Event> events_of(std::uint16_t wanted) {
    std::vector<Event> events;
    std::optional<std::uint64_t> first;
    for (std::size_t number = 1; reader_.rest() > 0; ++number) {
      const std::uint16_t id = reader_.u16();
      const std::uint64_t stamp = version_ == 1 ? reader_.u32() : reader_.u64();
      const auto type = types_.find(id);
      if (reader_.ok() && type == types_.end())
        fail(fmt::format("has event {} of type {}, which it does not describe", number, id));
      ByteReader content = reader_.part(reader_.ok() ? type->second.bytes : 1);
      if (!reader_.ok()) fail(fmt::format("ends within event {}", number));
      if (id != wanted) continue;
      if (!first) first = stamp;
      // A double holds the difference exactly.
      const auto ticks = static_cast<double>(static_cast<std::int64_t>(stamp - *first));
      Event event{ticks * (version_ == 1 ? 1e-3 : 1e-6), {}};
      for (const Variable& variable : type->second.variables)
        event.values.push_back(value_of(content, variable.type));
      events.push_back(std::move(event));
    }
    return events;
  }

  std::string names() const {
    std::string text;
    for (const auto& [id, type] : types_) {
      for (const Variable& variable : type.variables) text += (text.empty() ? "" : ", ") + variable.name;
    }
    return text.empty() ? "no variables" : fmt::format("{:.400}", text);
  }

  std::string_view all_;
  const std::string& file_;
  ByteReader reader_;
  int version_ = 0;
  std::map<std::uint16_t, EventType> types_;  // by id
};

// A column of the table: of a variable, or of the quaternion.
struct Heading {
  std::optional<std::size_t> yaw_deg;
  std::array<std::optional<std::size_t>, 4> q;  // w, x, y, z

  bool has_quaternion() const {
    return std::all_of(q.begin(), q.end(), [](const auto& part) { return part.has_value(); });
  }
  // rad, counter-clockwise seen from above.
  double of(const std::vector<double>& values) const {
    if (yaw_deg) return math::kRadPerDeg * values[*yaw_deg];
    const double w = values[*q[0]], x = values[*q[1]], y = values[*q[2]], z = values[*q[3]];
    return std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
  }
};

}  // namespace

bool is_crazyflie_log(std::string_view bytes) {
  return !bytes.empty() && static_cast<std::uint8_t>(bytes.front()) == kMagic;
}

MissionTable read_crazyflie_log(std::string_view bytes, const std::string& file_name) {
  const auto [type, events] = CrazyflieReader(bytes, file_name).read();
  Heading heading{type.find("stateestimate.yaw"),
                  {type.find("stateestimate.qw"), type.find("stateestimate.qx"),
                   type.find("stateestimate.qy"), type.find("stateestimate.qz")}};
  const bool turns = heading.yaw_deg || heading.has_quaternion();
  MissionTable log{{file_name, turns ? std::vector<std::string>{"t", "x", "y", "z", "yaw"}
                                     : std::vector<std::string>{"t", "x", "y", "z"}},
                   {}};
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::vector<double>& values = events[i].values;
    std::vector<std::string> row = {fmt::format("{:.6f}", events[i].time_s)};
    for (const char* const axis : {"x", "y", "z"})
      row.push_back(fmt::format("{:.6f}", values[*type.find(std::string("stateestimate.") + axis)]));
    if (turns) row.push_back(fmt::format("{:.5f}", std::remainder(heading.of(values), 2.0 * M_PI)));
    if (!std::all_of(row.begin(), row.end(), is_number))
      throw ConfigError(file_name, 0, "", fmt::format("event {} has an estimate that is not finite", i + 1));
    log.table.add_row(static_cast<int>(i) + 2, std::vector<std::string_view>(row.begin(), row.end()));
  }
  log.assumptions.push_back(fmt::format(
      "a log of a Crazyflie: the estimated position{} of its {} events {}; line n of messages is event n - 1",
      turns ? " and yaw" : "", events.size(), type.name));
  return log;
}

}  // namespace swiftlet::io

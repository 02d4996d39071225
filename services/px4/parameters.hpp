// The parameters that PX4 needs to be flown by Swiftlet, and PX4's parameters over MAVLink.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/descriptor.hpp"
#include "swiftlet/io/mavlink/frame.hpp"
#include "swiftlet/io/mavlink/frame_parser.hpp"

namespace swiftlet::px4 {

// PX4 has whole numbers and reals.
struct ParameterValue {
  bool is_whole = false;
  double value = 0.0;

  bool operator==(const ParameterValue& other) const {
    return is_whole == other.is_whole && value == other.value;
  }
};
std::string to_string(const ParameterValue& value);  // "11", "0.01"

struct RequiredParameter {
  const char* name;
  ParameterValue value;
  const char* why;
};
// With a remote control, what concerns its absence is left out.
std::vector<RequiredParameter> required_parameters(bool has_remote_control);

// A session with PX4's MAVLink over UDP, for its parameters. What is lost is asked for again.
class ParameterClient {
 public:
  // host: PX4's IPv4 address. port: of PX4, 14580 and the instance. own_port: to which PX4 sends, 14540 and the instance; 0: any. Throws
  // std::runtime_error with a sentence if the port is in use.
  ParameterClient(const std::string& host, int port, int own_port, std::uint8_t system);

  // nullopt: PX4 does not answer, or has no such parameter.
  std::optional<ParameterValue> read(const std::string& name);
  // The value that PX4 has then; it may not take one that is out of range.
  std::optional<ParameterValue> set(const std::string& name, const ParameterValue& value);

 private:
  template <class Message>
  std::optional<ParameterValue> ask(const Message& message, const std::string& name);
  std::optional<ParameterValue> receive(const std::string& name, std::chrono::steady_clock::time_point until);

  io::Descriptor socket_;
  const std::uint8_t system_;
  std::uint8_t sequence_ = 0;
  mavlink::FrameParser parser_;
};

struct ParameterCheck {
  RequiredParameter required;
  std::optional<ParameterValue> found;  // nullopt: no answer
  bool was_set = false;                 // to the required value, now

  bool holds() const { return found && *found == required.value; }
};
// Reads all, and sets those that differ if `set`.
std::vector<ParameterCheck> check_parameters(ParameterClient& client,
                                             const std::vector<RequiredParameter>& required, bool set);
// A line for each.
std::string table_of(const std::vector<ParameterCheck>& checks);

}  // namespace swiftlet::px4

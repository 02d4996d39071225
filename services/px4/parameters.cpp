#include "swiftlet/services/px4/parameters.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>

#include <fmt/core.h>

#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/io/mavlink/payload.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/px4/words.hpp"

namespace swiftlet::px4 {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kAnswerTime = 300ms;
constexpr int kTries = 5;
constexpr mavlink::Address kOwnAddress{255, 191};  // as a ground station's onboard computer

constexpr ParameterValue whole(int value) { return {true, static_cast<double>(value)}; }
constexpr ParameterValue real(double value) { return {false, value}; }

std::array<char, 16> id_of(const std::string& name) {
  std::array<char, 16> id{};
  std::copy_n(name.begin(), std::min(name.size(), id.size()), id.begin());
  return id;
}
std::string name_of(const std::array<char, 16>& id) {
  return {id.begin(), std::find(id.begin(), id.end(), '\0')};
}

// A whole number lies in the bytes of the float.
ParameterValue value_of(const mavlink::ParamValue& message) {
  if (message.param_type != mavlink::kParamInt32) return real(message.param_value);
  std::int32_t number = 0;
  std::memcpy(&number, &message.param_value, sizeof number);
  return whole(number);
}
float bytes_of(const ParameterValue& value) {
  if (!value.is_whole) return static_cast<float>(value.value);
  const auto number = static_cast<std::int32_t>(value.value);
  float bytes = 0.0F;
  std::memcpy(&bytes, &number, sizeof bytes);
  return bytes;
}

// Reals are stored as 32 bits.
bool same(const ParameterValue& a, const ParameterValue& b) {
  return a.is_whole == b.is_whole && static_cast<float>(a.value) == static_cast<float>(b.value);
}

}  // namespace

std::string to_string(const ParameterValue& value) {
  return value.is_whole ? fmt::format("{:.0f}", value.value) : fmt::format("{:g}", value.value);
}

std::vector<RequiredParameter> required_parameters(bool has_remote_control) {
  std::vector<RequiredParameter> list = {
      {"EKF2_EV_CTRL", whole(11), "position and heading come from motion capture"},
      {"EKF2_HGT_REF", whole(3), "the height too"},
      {"EKF2_EVP_NOISE", real(0.01), "motion capture is exact"},
      {"EKF2_GPS_CTRL", whole(0), "no GPS beside it"},
      {"EKF2_BARO_CTRL", whole(0), "no barometer beside it"},
      {"EKF2_MAG_TYPE", whole(5), "no magnetometer beside it"},
      {"THR_MDL_FAC", real(0.0), "swiftlet-px4 knows the thrust curve of the motors"},
      {"COM_OBL_RC_ACT", whole(4), "without setpoints, or when control dies, PX4 lands"},
      {"COM_OF_LOSS_T", real(0.5), "s without setpoints until then"},
      {"COM_SPOOLUP_TIME", real(0.0), "control spools the rotors up"},
      {"MPC_TKO_RAMP_T", real(0.0), "control plans the take-off"},
  };
  if (has_remote_control) return list;
  const std::vector<RequiredParameter> without = {
      {"COM_RC_IN_MODE", whole(4), "there is no remote control"},
      {"COM_RCL_EXCEPT", whole(4), "its absence is no failsafe in offboard mode"},
      {"NAV_DLL_ACT", whole(0), "nor is that of a ground station"},
  };
  list.insert(list.end(), without.begin(), without.end());
  return list;
}

ParameterClient::ParameterClient(const std::string& host, int port, int own_port, std::uint8_t system)
    : system_(system) {
  const sockaddr_in own = io::socket_address("", own_port);
  const sockaddr_in px4 = io::socket_address(host, port);
  socket_ = io::Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int fd = socket_.get();
  const bool bound = fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0;
  if (bound && ::connect(fd, reinterpret_cast<const sockaddr*>(&px4), sizeof px4) == 0) return;
  const std::string fault = std::strerror(errno);
  throw std::runtime_error(fmt::format("cannot use UDP port {} for MAVLink: {}", own_port, fault));
}

std::optional<ParameterValue> ParameterClient::read(const std::string& name) {
  mavlink::ParamRequestRead request;
  request.target_system = system_;
  request.target_component = kAutopilotComponent;
  request.param_id = id_of(name);
  return ask(request, name);
}

std::optional<ParameterValue> ParameterClient::set(const std::string& name, const ParameterValue& value) {
  mavlink::ParamSet request;
  request.target_system = system_;
  request.target_component = kAutopilotComponent;
  request.param_id = id_of(name);
  request.param_value = bytes_of(value);
  request.param_type = value.is_whole ? mavlink::kParamInt32 : mavlink::kParamReal32;
  return ask(request, name);
}

template <class Message>
std::optional<ParameterValue> ParameterClient::ask(const Message& message, const std::string& name) {
  for (int i = 0; i < kTries; ++i) {
    const mavlink::FrameBytes frame =
        mavlink::encode(mavlink::to_frame(message, kOwnAddress, sequence_++), Message::kCrcExtra);
    ::send(socket_.get(), frame.data.data(), frame.size,
           MSG_NOSIGNAL);  // a refused datagram is asked for again
    if (const auto value = receive(name, Clock::now() + kAnswerTime)) return value;
  }
  return std::nullopt;
}

std::optional<ParameterValue> ParameterClient::receive(const std::string& name, Clock::time_point until) {
  std::array<std::uint8_t, 2048> bytes{};
  std::optional<ParameterValue> value;
  while (!value) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
    if (left.count() <= 0) break;
    pollfd wait{socket_.get(), POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(left.count())) <= 0) continue;
    const ssize_t size = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size <= 0) {
      if (errno == ECONNREFUSED) ::poll(nullptr, 0, 20);  // nobody listens there yet
      continue;
    }
    parser_.reset();
    parser_.feed(bytes.data(), static_cast<std::size_t>(size), [&](const mavlink::Frame& frame) {
      if (frame.message_id != mavlink::ParamValue::kId || frame.system_id != system_) return;
      const auto message = mavlink::from_frame<mavlink::ParamValue>(frame);
      if (name_of(message.param_id) == name) value = value_of(message);
    });
  }
  return value;
}

std::vector<ParameterCheck> check_parameters(ParameterClient& client,
                                             const std::vector<RequiredParameter>& required, bool set) {
  std::vector<ParameterCheck> checks;
  for (const RequiredParameter& parameter : required) {
    ParameterCheck check{parameter, client.read(parameter.name)};
    if (check.found && same(*check.found, parameter.value)) check.found = parameter.value;
    if (set && check.found && !check.holds()) {
      const std::optional<ParameterValue> now = client.set(parameter.name, parameter.value);
      check.was_set = now && same(*now, parameter.value);
      if (check.was_set) check.found = parameter.value;
    }
    checks.push_back(check);
  }
  return checks;
}

std::string table_of(const std::vector<ParameterCheck>& checks) {
  std::string text = fmt::format("{:<17} {:>9} {:>9}  {:<10} {}\n", "parameter", "PX4", "needed", "", "why");
  for (const ParameterCheck& check : checks) {
    const char* state = check.was_set ? "set" : check.holds() ? "ok" : check.found ? "differs" : "no answer";
    text += fmt::format("{:<17} {:>9} {:>9}  {:<10} {}\n", check.required.name,
                        check.found ? to_string(*check.found) : "-", to_string(check.required.value), state,
                        check.required.why);
  }
  return text;
}

}  // namespace swiftlet::px4

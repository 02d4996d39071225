// PX4's parameters over MAVLink, from a scripted PX4 behind a UDP port that loses datagrams.
#include "swiftlet/services/px4/parameters.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/io/mavlink/payload.hpp"
#include "swiftlet/io/network/sockets.hpp"

namespace swiftlet::px4::parameters_test {

// Answers as PX4 does: PARAM_VALUE to the sender; nothing for a name that it does not have.
class ScriptedParameters {
 public:
  explicit ScriptedParameters(int lose_every) : lose_every_(lose_every) {
    socket_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address = io::socket_address("127.0.0.1", 0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~ScriptedParameters() {
    stop_ = true;
    thread_.join();
    ::close(socket_);
  }

  // Before the first request.
  std::map<std::string, ParameterValue> values;
  int port = 0;

 private:
  void run() {
    mavlink::FrameParser parser;
    std::array<std::uint8_t, 2048> bytes{};
    while (!stop_) {
      pollfd wait{socket_, POLLIN, 0};
      if (::poll(&wait, 1, 20) <= 0) continue;
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const ssize_t received =
          ::recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
      if (received <= 0 || ++received_ % lose_every_ == 0) continue;
      parser.feed(bytes.data(), static_cast<std::size_t>(received),
                  [&](const mavlink::Frame& frame) { answer(frame, from); });
    }
  }
  // A name of 16 letters has no terminating 0.
  static std::string name_of(const mavlink::ParamId& id) {
    return {id.begin(), std::find(id.begin(), id.end(), '\0')};
  }
  void answer(const mavlink::Frame& frame, const sockaddr_in& to) {
    std::string name;
    if (frame.message_id == mavlink::ParamRequestRead::kId)
      name = name_of(mavlink::from_frame<mavlink::ParamRequestRead>(frame).param_id);
    if (frame.message_id == mavlink::ParamSet::kId) {
      const auto request = mavlink::from_frame<mavlink::ParamSet>(frame);
      name = name_of(request.param_id);
      ParameterValue& value = values[name];
      std::int32_t whole = 0;
      std::memcpy(&whole, &request.param_value, sizeof whole);
      value.value = value.is_whole ? whole : request.param_value;
    }
    const auto found = values.find(name);
    if (found == values.end()) return;
    mavlink::ParamValue message;
    std::copy(name.begin(), name.end(), message.param_id.begin());
    message.param_value = static_cast<float>(found->second.value);
    message.param_type = mavlink::kParamReal32;
    if (found->second.is_whole) {
      const auto whole = static_cast<std::int32_t>(found->second.value);
      std::memcpy(&message.param_value, &whole, sizeof whole);
      message.param_type = mavlink::kParamInt32;
    }
    const mavlink::FrameBytes out =
        mavlink::encode(mavlink::to_frame(message, {1, 1}, 0), mavlink::ParamValue::kCrcExtra);
    ::sendto(socket_, out.data.data(), out.size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  const int lose_every_;
  int socket_ = -1;
  int received_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(Px4Parameters, AreReadComparedAndSetAlthoughDatagramsAreLost) {
  ScriptedParameters px4(3);
  const std::vector<RequiredParameter> required = required_parameters(false);
  for (const RequiredParameter& parameter : required) px4.values[parameter.name] = parameter.value;
  px4.values["EKF2_EV_CTRL"].value = 15;
  px4.values["EKF2_EVP_NOISE"].value = 0.1;
  ParameterClient client("127.0.0.1", px4.port, 0, 1);

  const std::vector<ParameterCheck> before = check_parameters(client, required, false);
  EXPECT_EQ(std::count_if(before.begin(), before.end(), [](const auto& check) { return check.holds(); }),
            static_cast<std::ptrdiff_t>(required.size()) - 2);
  EXPECT_NE(table_of(before).find("EKF2_EV_CTRL             15        11  differs"), std::string::npos)
      << table_of(before);

  const std::vector<ParameterCheck> set = check_parameters(client, required, true);
  EXPECT_EQ(std::count_if(set.begin(), set.end(), [](const auto& check) { return check.was_set; }), 2);
  EXPECT_TRUE(std::all_of(set.begin(), set.end(), [](const auto& check) { return check.holds(); }));
  const auto noise = client.read("EKF2_EVP_NOISE");
  ASSERT_TRUE(noise);
  EXPECT_FLOAT_EQ(static_cast<float>(noise->value), 0.01F);
}

TEST(Px4Parameters, OnesThatPx4DoesNotHaveAreTold) {
  ScriptedParameters px4(1000);
  ParameterClient client("127.0.0.1", px4.port, 0, 1);
  EXPECT_FALSE(client.read("NO_SUCH_NAME"));
  const std::vector<ParameterCheck> checks =
      check_parameters(client, {{"NO_SUCH_NAME", {true, 1.0}, "a test"}}, true);
  EXPECT_NE(table_of(checks).find("no answer"), std::string::npos);
}

TEST(Px4Parameters, AnAddressThatIsNoneIsRefused) {
  EXPECT_THROW(ParameterClient("nobody", 1, 0, 1), std::runtime_error);
}

}  // namespace swiftlet::px4::parameters_test

#include "swiftlet/services/plant/serial_port.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <stdexcept>
#include <termios.h>
#include <unistd.h>

#include <fmt/core.h>

namespace swiftlet::services {
namespace {

const std::map<int, speed_t>& speeds() {
  static const std::map<int, speed_t> all = {
      {57'600, B57600},      {115'200, B115200},   {230'400, B230400},    {460'800, B460800},
      {500'000, B500000},    {921'600, B921600},   {1'000'000, B1000000}, {1'500'000, B1500000},
      {2'000'000, B2000000}, {3'000'000, B3000000}};
  return all;
}

[[noreturn]] void fail(const std::string& device, int error) {
  throw std::runtime_error(fmt::format("cannot open the serial device {}: {}", device, std::strerror(error)));
}

}  // namespace

const std::vector<std::string>& serial_bauds() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> texts;
    for (const auto& [baud, speed] : speeds()) texts.push_back(std::to_string(baud));
    return texts;
  }();
  return all;
}

std::unique_ptr<ByteStream> open_serial_port(const std::string& device, int baud) {
  const int descriptor = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) fail(device, errno);
  auto port = std::make_unique<ByteStream>(descriptor);
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) fail(device, errno);
  ::cfmakeraw(&settings);
  settings.c_cflag = (settings.c_cflag & ~static_cast<tcflag_t>(CSTOPB | CRTSCTS)) | CLOCAL | CREAD;
  settings.c_cc[VMIN] = 1;  // a read without bytes fails with EAGAIN, so that 0 means a hang-up
  settings.c_cc[VTIME] = 0;
  const speed_t speed = speeds().at(baud);
  if (::cfsetspeed(&settings, speed) != 0 || ::tcsetattr(descriptor, TCSANOW, &settings) != 0)
    fail(device, errno);
  ::tcflush(descriptor, TCIOFLUSH);
  return port;
}

}  // namespace swiftlet::services

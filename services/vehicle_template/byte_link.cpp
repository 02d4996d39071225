#include "swiftlet/services/vehicle_template/byte_link.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <fcntl.h>
#include <iterator>
#include <linux/serial.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>
#include <utility>

#include "swiftlet/services/dds/discovery/host_address.hpp"

namespace swiftlet::services {
namespace {

struct Baud {
  int rate;
  speed_t code;
};
constexpr Baud kBauds[] = {
    {115'200, B115200},    {230'400, B230400},    {460'800, B460800},    {500'000, B500000},
    {576'000, B576000},    {921'600, B921600},    {1'000'000, B1000000}, {1'152'000, B1152000},
    {1'500'000, B1500000}, {2'000'000, B2000000}, {2'500'000, B2500000}, {3'000'000, B3000000},
    {3'500'000, B3500000}, {4'000'000, B4000000},
};

const Baud* find(int rate) {
  const auto* const found =
      std::find_if(std::begin(kBauds), std::end(kBauds), [=](const Baud& baud) { return baud.rate == rate; });
  return found == std::end(kBauds) ? nullptr : found;
}

// 8 data bits, no parity, no flow control, no translation of bytes.
bool set_raw(int device, speed_t speed) noexcept {
  termios settings{};
  if (::tcgetattr(device, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;  // so that 0 bytes mean that the device has vanished
  settings.c_cc[VTIME] = 0;
  return ::cfsetspeed(&settings, speed) == 0 && ::tcsetattr(device, TCSANOW, &settings) == 0 &&
         ::tcflush(device, TCIOFLUSH) == 0;
}

// Some adapters collect bytes for up to 16 ms otherwise. Others have no such setting.
void ask_for_low_latency(int device) noexcept {
  serial_struct settings{};
  if (::ioctl(device, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  ::ioctl(device, TIOCSSERIAL, &settings);
}

}  // namespace

std::string fault_of_baud(int baud) {
  if (find(baud) != nullptr) return "";
  std::string rates;
  for (const Baud& known : kBauds) rates += (rates.empty() ? "" : ", ") + std::to_string(known.rate);
  return "is " + std::to_string(baud) + ", must be one of " + rates;
}

ByteLink::ByteLink(ByteLinkSettings settings) : settings_(std::move(settings)) {
  if (settings_.device.empty() == settings_.udp.empty())
    throw std::invalid_argument("the link: give either --device or --udp");
  if (!settings_.device.empty()) {
    const std::string fault = fault_of_baud(settings_.baud);
    if (!fault.empty()) throw std::invalid_argument("--baud: " + fault);
    return;
  }
  const std::string fault = comms::fault_of_host_address(settings_.udp);
  if (!fault.empty()) throw std::invalid_argument("--udp: " + fault);
  const comms::HostAddress address = comms::parse_host_address(settings_.udp);
  if (address.port == 0)
    throw std::invalid_argument("--udp: is '" + settings_.udp + "', must be HOST:PORT, with a port");
  far_end_.sin_family = AF_INET;
  far_end_.sin_port = htons(address.port);
  ::inet_pton(AF_INET, comms::ipv4_addresses_of(address.host).front().c_str(), &far_end_.sin_addr);
}

int ByteLink::open() noexcept {
  close();
  const int fault = settings_.device.empty() ? open_socket() : open_device();
  if (fault != 0) close();
  return fault;
}

int ByteLink::open_device() noexcept {
  descriptor_ = ::open(settings_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) return errno;
  if (::ioctl(descriptor_, TIOCEXCL) != 0) return errno;  // no second process on the line
  if (!set_raw(descriptor_, find(settings_.baud)->code)) return errno;
  ask_for_low_latency(descriptor_);
  return 0;
}

int ByteLink::open_socket() noexcept {
  descriptor_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor_ < 0) return errno;
  // Connected: only datagrams of the microcontroller are received.
  const auto* const address = reinterpret_cast<const sockaddr*>(&far_end_);
  return ::connect(descriptor_, address, sizeof far_end_) == 0 ? 0 : errno;
}

void ByteLink::close() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

std::size_t ByteLink::read(std::uint8_t* bytes, std::size_t room) noexcept {
  if (!is_open()) return 0;
  const ssize_t count = ::read(descriptor_, bytes, room);
  if (count > 0) return static_cast<std::size_t>(count);
  const bool is_only_empty = count < 0 && (errno == EAGAIN || errno == EINTR);
  if (settings_.device.empty() || is_only_empty) return 0;  // of UDP: the far end is not there yet
  close();
  return 0;
}

bool ByteLink::write(const std::uint8_t* bytes, std::size_t size) noexcept {
  return is_open() && ::write(descriptor_, bytes, size) == static_cast<ssize_t>(size);
}

}  // namespace swiftlet::services

#include "swiftlet/services/runtime/serial_device.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <iterator>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace swiftlet::runtime {
namespace {

struct Baud {
  int rate;
  speed_t code;
};
constexpr Baud kBauds[] = {
    {57'600, B57600},      {115'200, B115200},    {230'400, B230400},    {460'800, B460800},
    {500'000, B500000},    {576'000, B576000},    {921'600, B921600},    {1'000'000, B1000000},
    {1'152'000, B1152000}, {1'500'000, B1500000}, {2'000'000, B2000000}, {2'500'000, B2500000},
    {3'000'000, B3000000}, {3'500'000, B3500000}, {4'000'000, B4000000},
};

const Baud* find(int rate) {
  const auto* const found =
      std::find_if(std::begin(kBauds), std::end(kBauds), [=](const Baud& baud) { return baud.rate == rate; });
  return found == std::end(kBauds) ? nullptr : found;
}

// TIOCEXCL would outlive this process where another one, such as the far end of a pseudo-terminal, keeps the device open.
bool lock(int device) noexcept {
  if (::flock(device, LOCK_EX | LOCK_NB) == 0) return true;
  if (errno == EWOULDBLOCK) errno = EBUSY;
  return false;
}

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

int open_serial_device(const char* device, int baud) noexcept {
  const int descriptor = ::open(device, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return -errno;
  if (lock(descriptor) && set_raw(descriptor, find(baud)->code)) {
    ask_for_low_latency(descriptor);
    return descriptor;
  }
  const int fault = errno;
  ::close(descriptor);
  return -fault;
}

}  // namespace swiftlet::runtime

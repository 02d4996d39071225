#include "swiftlet/ground/teleop/input_device.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace swiftlet::ground {
namespace {

constexpr std::size_t kEventsPerRead = 64;

int open_device(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd >= 0) return fd;
  std::string reason = "cannot open " + path + ": " + std::strerror(errno);
  if (errno == EACCES) reason += "; members of the group 'input' may read it";
  throw std::runtime_error(reason);
}

bool is_fifo(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 && S_ISFIFO(status.st_mode);
}

bool is_event_device(int fd) {
  int version = 0;
  return ioctl(fd, EVIOCGVERSION, &version) == 0;
}

GamepadAxes axes_of(int fd) {
  GamepadAxes axes;
  for (const int code : {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ}) {
    input_absinfo info{};
    // An axis that the device does not have is reported as all zero.
    if (ioctl(fd, EVIOCGABS(code), &info) == 0 && info.maximum > info.minimum)
      axes[code] = {info.minimum, info.maximum, info.flat, info.value};
  }
  return axes;
}

std::string name_of(int fd, const std::string& path) {
  std::array<char, 128> name{};
  return ioctl(fd, EVIOCGNAME(name.size() - 1), name.data()) > 0 ? name.data() : path;
}

}  // namespace

InputDevice::InputDevice(const std::string& path) : fd_(open_device(path)), name_(name_of(fd_, path)) {
  try {
    if (!is_fifo(fd_) && !is_event_device(fd_))
      throw std::runtime_error("is not an event device; they are /dev/input/event*");
    gamepad_.emplace(is_fifo(fd_) ? usual_axes() : axes_of(fd_));
  } catch (const std::runtime_error& error) {
    close(fd_);
    throw std::runtime_error(path + " " + error.what());
  }
}

InputDevice::~InputDevice() { close(fd_); }

bool InputDevice::update() {
  pollfd device{fd_, POLLIN, 0};
  while (poll(&device, 1, 0) > 0) {
    if ((device.revents & POLLIN) != 0 && read_events()) continue;
    gamepad_->release_buttons();
    return false;
  }
  return true;
}

// Returns false if nothing will come any more.
bool InputDevice::read_events() {
  std::array<char, kEventsPerRead * sizeof(input_event)> bytes{};
  const ssize_t count = read(fd_, bytes.data(), bytes.size());
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  if (count == 0) return false;
  unread_.append(bytes.data(), static_cast<std::size_t>(count));
  std::size_t taken = 0;
  for (; taken + sizeof(input_event) <= unread_.size(); taken += sizeof(input_event)) {
    input_event event{};
    std::memcpy(&event, unread_.data() + taken, sizeof event);
    gamepad_->take(event);
  }
  unread_.erase(0, taken);
  return true;
}

}  // namespace swiftlet::ground

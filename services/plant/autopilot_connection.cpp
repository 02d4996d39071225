#include "swiftlet/services/plant/autopilot_connection.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <poll.h>
#include <stdexcept>
#include <time.h>

#include <fmt/core.h>

#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/serial_device.hpp"

namespace swiftlet::services {
namespace {

constexpr std::int64_t kReopenPeriodNs = 500'000'000;
constexpr std::int64_t kConnectionLogPeriodNs = 10'000'000'000;
constexpr int kLinesPerPeriod = 6;

}  // namespace

AutopilotConnection::AutopilotConnection(const AutopilotSettings& settings) : settings_(settings) {
  if (settings_.device.empty()) {
    listener_.emplace(settings_.address, settings_.port);
  } else {
    const int descriptor = runtime::open_serial_device(settings_.device.c_str(), settings_.baud);
    if (descriptor < 0)
      throw std::runtime_error(
          fmt::format("cannot open the serial device {}: {}", settings_.device, std::strerror(-descriptor)));
    stream_ = std::make_unique<ByteStream>(descriptor);
    connections_ = 1;
  }
}

std::size_t AutopilotConnection::receive(std::int64_t deadline_ns, std::uint8_t* bytes, std::size_t size) {
  if (!stream_ && connect()) return 0;
  const bool failed = stream_ && stream_->closed();
  if (!failed && !wait(deadline_ns)) return 0;
  if (!stream_) {
    connect();
    return 0;
  }
  const std::size_t received = stream_->receive(bytes, size);
  if (stream_->closed()) {
    log_line(true, "autopilot disconnected");
    stream_.reset();
    reopen_ns_ = runtime::monotonic_ns() + kReopenPeriodNs;
  } else {
    refuse_second();
  }
  return received;
}

// True if there is something to read or to accept.
bool AutopilotConnection::wait(std::int64_t deadline_ns) const {
  std::array<pollfd, 2> waits{};
  waits[0] = {stream_ ? stream_->descriptor() : -1, POLLIN, 0};
  waits[1] = {listener_ ? listener_->descriptor() : -1, POLLIN, 0};
  const std::int64_t left_ns =
      std::clamp<std::int64_t>(deadline_ns - runtime::monotonic_ns(), 0, kLongestWaitNs);
  const timespec time{0, static_cast<long>(left_ns)};
  return ::ppoll(waits.data(), waits.size(), &time, nullptr) > 0;
}

// Returns true if a connection has begun.
bool AutopilotConnection::connect() {
  if (listener_) {
    stream_ = listener_->accept();
  } else if (runtime::monotonic_ns() >= reopen_ns_) {
    reopen_ns_ = runtime::monotonic_ns() + kReopenPeriodNs;
    const int descriptor = runtime::open_serial_device(settings_.device.c_str(), settings_.baud);
    if (descriptor >= 0) stream_ = std::make_unique<ByteStream>(descriptor);
  }
  if (!stream_) return false;
  ++connections_;
  log_line(false, "autopilot connected");
  return true;
}

// A program that connects and ends again and again must not fill the log.
void AutopilotConnection::log_line(bool is_warning, const char* text) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (now_ns - log_period_ns_ >= kConnectionLogPeriodNs) {
    if (unlogged_ > 0) runtime::log_warning("autopilot: {} more connections and disconnections", unlogged_);
    log_period_ns_ = now_ns;
    logged_ = unlogged_ = 0;
  }
  if (++logged_ > kLinesPerPeriod) {
    ++unlogged_;
  } else {
    is_warning ? runtime::log_warning("{}", text) : runtime::log_info("{}", text);
  }
}

void AutopilotConnection::refuse_second() {
  if (listener_ && listener_->accept())
    log_line(true, "refused a second connection: an autopilot is connected");
}

}  // namespace swiftlet::services

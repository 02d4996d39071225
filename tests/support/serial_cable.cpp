#include "tests/support/serial_cable.hpp"

#include <cstdint>
#include <poll.h>
#include <utility>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::tests {
namespace {

constexpr int kPatienceMs = 10;  // until it looks whether it was unplugged

}  // namespace

SerialCable::SerialCable(const std::string& microcontroller, std::string host)
    : microcontroller_({microcontroller, 921'600, ""}), host_(std::move(host)) {
  plug();
  up_ = std::thread([this] { carry_up(); });
  down_ = std::thread([this] { carry_down(); });
}

SerialCable::~SerialCable() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  plugged_.notify_one();
  up_.join();
  down_.join();
}

void SerialCable::unplug() {
  const std::lock_guard<std::mutex> lock(mutex_);
  port_.reset();
}

void SerialCable::plug() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    port_ = services::open_pseudo_terminal(host_);
  }
  plugged_.notify_one();
}

std::shared_ptr<services::Port> SerialCable::wait_until_plugged() {
  std::unique_lock<std::mutex> lock(mutex_);
  plugged_.wait(lock, [this] { return port_ || stop_; });
  return port_;
}

std::shared_ptr<services::Port> SerialCable::port() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return port_;
}

void SerialCable::carry_up() {
  std::mt19937 random(1);
  std::uint8_t bytes[1024];
  while (!stop_) {
    pollfd ready{-1, POLLIN, 0};
    {
      const std::lock_guard<std::mutex> lock(link_mutex_);
      if (!microcontroller_.is_open()) microcontroller_.open();
      ready.fd = microcontroller_.descriptor();
    }
    if (::poll(&ready, 1, kPatienceMs) <= 0) continue;
    std::size_t size = 0;
    {
      const std::lock_guard<std::mutex> lock(link_mutex_);
      size = microcontroller_.read(bytes, sizeof bytes);
    }
    if (const auto host = port()) host->write(bytes, disturb(random, bytes, size));
  }
}

void SerialCable::carry_down() {
  std::mt19937 random(2);
  std::uint8_t bytes[1024];
  while (!stop_) {
    const auto host = wait_until_plugged();
    if (!host) return;
    const std::int64_t until_ns = runtime::monotonic_ns() + kPatienceMs * 1'000'000;
    if (!host->wait_until(until_ns)) continue;
    const std::size_t size = disturb(random, bytes, host->read(bytes, sizeof bytes));
    const std::lock_guard<std::mutex> lock(link_mutex_);
    microcontroller_.write(bytes, size);
  }
}

std::size_t SerialCable::disturb(std::mt19937& random, std::uint8_t* bytes, std::size_t size) const {
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (chance(random) < loss) continue;
    bytes[kept++] = chance(random) < errors ? static_cast<std::uint8_t>(random()) : bytes[i];
  }
  return kept;
}

}  // namespace swiftlet::tests

// A serial cable between a microcontroller's terminal and one that it makes for the host. It can be unplugged, and lose or change
// bytes.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include "swiftlet/services/microcontroller/port.hpp"
#include "swiftlet/services/vehicle_template/byte_link.hpp"

namespace swiftlet::tests {

class SerialCable {
 public:
  // microcontroller: its terminal, which may appear later. host: the path of the other terminal.
  SerialCable(const std::string& microcontroller, std::string host);
  ~SerialCable();
  SerialCable(const SerialCable&) = delete;
  SerialCable& operator=(const SerialCable&) = delete;

  // At the host's end, whose terminal vanishes and comes back.
  void unplug();
  void plug();

  // Probability that a byte is lost, and that it arrives as another one.
  std::atomic<double> loss{0.0};
  std::atomic<double> errors{0.0};

 private:
  // Each carries the bytes of one direction.
  void carry_up();
  void carry_down();
  std::size_t disturb(std::mt19937& random, std::uint8_t* bytes, std::size_t size) const;
  std::shared_ptr<services::Port> port() const;
  std::shared_ptr<services::Port> wait_until_plugged();  // nullptr: at the end

  services::ByteLink microcontroller_;
  const std::string host_;
  mutable std::mutex mutex_;  // guards port_
  std::shared_ptr<services::Port> port_;
  std::condition_variable plugged_;
  std::atomic<bool> stop_{false};
  std::mutex link_mutex_;  // guards microcontroller_
  std::thread up_, down_;
};

}  // namespace swiftlet::tests

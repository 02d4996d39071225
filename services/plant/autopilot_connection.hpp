// The link to one autopilot: a TCP server that it connects to, or a serial device. Opens again what was lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "swiftlet/services/plant/autopilot_settings.hpp"
#include "swiftlet/services/plant/byte_stream.hpp"
#include "swiftlet/services/plant/tcp_listener.hpp"

namespace swiftlet::services {

class AutopilotConnection {
 public:
  // Throws as TcpListener does, std::runtime_error if the serial device cannot be opened. Precondition:
  // runtime::fault_of_baud(settings.baud) is empty.
  explicit AutopilotConnection(const AutopilotSettings& settings);

  bool connected() const { return stream_ && !stream_->closed(); }
  std::uint64_t connections() const { return connections_; }  // so far

  // Sends all bytes or none, see ByteStream.
  bool send(const std::uint8_t* bytes, std::size_t size) { return stream_ && stream_->send(bytes, size); }
  // Waits until deadline_ns, monotonic, for bytes and returns their number; also returns, with 0, as soon as the
  // connection begins or ends, and after kLongestWaitNs at the latest. A deadline in the past does not wait.
  std::size_t receive(std::int64_t deadline_ns, std::uint8_t* bytes, std::size_t size);

  static constexpr std::int64_t kLongestWaitNs = 20'000'000;

 private:
  bool wait(std::int64_t deadline_ns) const;
  bool connect();
  void refuse_second();
  void log_line(bool is_warning, const char* text);

  AutopilotSettings settings_;
  std::optional<TcpListener> listener_;
  std::unique_ptr<ByteStream> stream_;
  std::uint64_t connections_ = 0;
  std::int64_t log_period_ns_ = 0;  // begin of the present period of log lines
  int logged_ = 0;
  int unlogged_ = 0;
  std::int64_t reopen_ns_ = 0;
};

}  // namespace swiftlet::services

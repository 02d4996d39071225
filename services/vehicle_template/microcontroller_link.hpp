// A session with a microcontroller over a link: handshake, its clock, and frames both ways. It begins by itself as soon as the
// microcontroller answers, and again after each interruption.
//
//   link.wait();                                // for bytes, wake(), or the next duty
//   while (const auto* frame = link.next()) ... // what the microcontroller has sent
//   link.send(command);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "swiftlet/services/clocks/clock_filter.hpp"
#include "swiftlet/services/microcontroller/protocol/frame.hpp"
#include "swiftlet/services/microcontroller/protocol/messages.hpp"
#include "swiftlet/services/vehicle_template/byte_link.hpp"

namespace swiftlet::services {

enum class LinkState : std::uint8_t {
  kClosed,    // there is no such device
  kGreeting,  // sends Hello; the microcontroller does not answer yet
  kConnected,
};

struct LinkStatus {
  LinkState state = LinkState::kClosed;
  int open_fault = 0;  // errno, while it is closed; 0 before the first attempt
  std::optional<protocol::HelloReply> microcontroller;  // the last that answered
  std::uint32_t sessions = 0;
  protocol::FrameDecoder::Counts frames;       // from the microcontroller
  std::uint32_t unsent = 0;                    // frames that the link could not take
  std::optional<clocks::ClockEstimate> clock;  // microcontroller's minus monotonic; empty: unknown
};

// All but wake() belong to one thread. Nothing allocates after construction, and nothing but wait() waits.
class MicrocontrollerLink {
 public:
  // Throws as ByteLink does, and std::system_error.
  explicit MicrocontrollerLink(const ByteLinkSettings& settings);
  ~MicrocontrollerLink();
  MicrocontrollerLink(const MicrocontrollerLink&) = delete;
  MicrocontrollerLink& operator=(const MicrocontrollerLink&) = delete;

  // Waits for bytes, for wake(), or at most until a duty of the session is due; then does it.
  void wait() noexcept;
  // Ends wait(). From any thread, also a real-time one.
  void wake() noexcept;

  // The next frame of a session, nullptr if there is none. HelloReply and TimeReply are not among them.
  const protocol::Frame* next() noexcept;
  // When the bytes of these frames were read; monotonic.
  std::int64_t arrived_ns() const { return arrived_ns_; }

  // Does nothing without a session.
  void send(const protocol::Command& command) noexcept;

  const LinkStatus& status() const { return status_; }
  // Microcontroller's clock at a monotonic time; nullopt while it is unknown.
  std::optional<std::int64_t> clock_ns(std::int64_t monotonic_ns) const noexcept;

 private:
  void do_duty(std::int64_t now_ns) noexcept;
  bool is_own(const protocol::Frame& frame) noexcept;
  void on_hello_reply(const protocol::HelloReply& reply) noexcept;
  void on_time_reply(const protocol::TimeReply& reply) noexcept;
  void update_clock() noexcept;
  template <class Message>
  void transmit(const Message& message) noexcept;

  ByteLink bytes_;
  int wake_ = -1;
  std::array<std::uint8_t, 1024> received_{};
  std::size_t received_size_ = 0;
  std::size_t taken_ = 0;
  std::int64_t arrived_ns_ = 0;
  protocol::FrameDecoder decoder_;
  protocol::FrameEncoder encoder_;
  LinkStatus status_;
  clocks::ClockFilter clock_;
  std::int64_t duty_due_ns_ = 0;
  std::int64_t heard_ns_ = 0;  // last frame of the session
};

}  // namespace swiftlet::services

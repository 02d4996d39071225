#include "swiftlet/services/vehicle_template/microcontroller_link.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <poll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::int64_t kOpenPeriodNs = 200'000'000;
constexpr std::int64_t kHelloPeriodNs = 100'000'000;
constexpr std::int64_t kTimeRequestPeriodNs = 50'000'000;
constexpr std::int64_t kSilenceNs =
    500'000'000;  // without a frame of the microcontroller the session has ended

}  // namespace

MicrocontrollerLink::MicrocontrollerLink(const ByteLinkSettings& settings)
    : bytes_(settings), wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wake_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

MicrocontrollerLink::~MicrocontrollerLink() { ::close(wake_); }

void MicrocontrollerLink::wake() noexcept { ::eventfd_write(wake_, 1); }

void MicrocontrollerLink::wait() noexcept {
  const std::int64_t wait_ns = std::max<std::int64_t>(duty_due_ns_ - runtime::monotonic_ns(), 0);
  const timespec time{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
  pollfd ready[] = {{wake_, POLLIN, 0}, {bytes_.descriptor(), POLLIN, 0}};
  ::ppoll(ready, 2, &time, nullptr);
  eventfd_t wakes = 0;
  if (ready[0].revents != 0) ::eventfd_read(wake_, &wakes);
  taken_ = received_size_ = 0;
  if (ready[1].revents != 0) received_size_ = bytes_.read(received_.data(), received_.size());
  arrived_ns_ = runtime::monotonic_ns();
  if (!bytes_.is_open() || arrived_ns_ >= duty_due_ns_) do_duty(arrived_ns_);
}

// What a session needs from the host by time: an open device, Hello, time requests.
void MicrocontrollerLink::do_duty(std::int64_t now_ns) noexcept {
  if (!bytes_.is_open()) {
    if (status_.state != LinkState::kClosed) status_.open_fault = ENODEV;  // it has vanished
    status_.state = LinkState::kClosed;
    if (now_ns < duty_due_ns_) return;
    status_.open_fault = bytes_.open();
    duty_due_ns_ = now_ns + (status_.open_fault == 0 ? 0 : kOpenPeriodNs);
    if (status_.open_fault == 0) status_.state = LinkState::kGreeting;
    return;
  }
  if (status_.state == LinkState::kConnected && now_ns - heard_ns_ > kSilenceNs)
    status_.state = LinkState::kGreeting;
  if (status_.state == LinkState::kConnected) {
    transmit(protocol::TimeRequest{now_ns});
    duty_due_ns_ = now_ns + kTimeRequestPeriodNs;
  } else {
    transmit(protocol::Hello{});
    duty_due_ns_ = now_ns + kHelloPeriodNs;
  }
}

const protocol::Frame* MicrocontrollerLink::next() noexcept {
  while (taken_ < received_size_) {
    const bool ends_frame = decoder_.take(received_[taken_++]);
    status_.frames = decoder_.counts();
    if (!ends_frame) continue;
    const protocol::Frame& frame = decoder_.frame();
    if (is_own(frame) || status_.state != LinkState::kConnected) continue;
    heard_ns_ = arrived_ns_;
    return &frame;
  }
  return nullptr;
}

// Returns true for the frames of the session itself.
bool MicrocontrollerLink::is_own(const protocol::Frame& frame) noexcept {
  if (const auto reply = protocol::message_of<protocol::HelloReply>(frame)) {
    on_hello_reply(*reply);
    return true;
  }
  if (const auto reply = protocol::message_of<protocol::TimeReply>(frame)) {
    on_time_reply(*reply);
    return true;
  }
  return false;
}

void MicrocontrollerLink::on_hello_reply(const protocol::HelloReply& reply) noexcept {
  const bool is_known = status_.microcontroller && status_.microcontroller->boot == reply.boot;
  if (!is_known) {  // its clock and its sequence numbers have started again
    clock_ = {};
    decoder_.expect_any_sequence();
  }
  status_.microcontroller = reply;
  if (reply.version != protocol::kVersion || status_.state == LinkState::kConnected) return;
  status_.state = LinkState::kConnected;
  ++status_.sessions;
  heard_ns_ = arrived_ns_;
  duty_due_ns_ = arrived_ns_;
  update_clock();
}

void MicrocontrollerLink::on_time_reply(const protocol::TimeReply& reply) noexcept {
  if (status_.state != LinkState::kConnected) return;
  heard_ns_ = arrived_ns_;
  clock_.add({reply.sent_ns, protocol::ns_of_us(reply.received_us), protocol::ns_of_us(reply.answered_us),
              arrived_ns_});
  update_clock();
}

void MicrocontrollerLink::update_clock() noexcept {
  status_.clock = clock_.is_in_doubt() ? std::nullopt : clock_.estimate();
}

std::optional<std::int64_t> MicrocontrollerLink::clock_ns(std::int64_t monotonic_ns) const noexcept {
  if (status_.state != LinkState::kConnected || !status_.clock) return std::nullopt;
  return monotonic_ns + status_.clock->offset_at(monotonic_ns);
}

void MicrocontrollerLink::send(const protocol::Command& command) noexcept {
  if (status_.state == LinkState::kConnected) transmit(command);
}

template <class Message>
void MicrocontrollerLink::transmit(const Message& message) noexcept {
  const protocol::FrameEncoder::Bytes frame = encoder_.encode(message);
  if (!bytes_.write(frame.data, frame.size)) ++status_.unsent;
}

}  // namespace swiftlet::services

#include "swiftlet/services/runtime/stop_signal.hpp"

#include <cerrno>
#include <csignal>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <system_error>
#include <unistd.h>

namespace swiftlet::runtime {

StopSignal::StopSignal() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  const int error = pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot block signals");
  signal_fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  event_fd_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (signal_fd_ < 0 || event_fd_ < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot listen for signals");
  }
}

StopSignal::~StopSignal() {
  ::close(signal_fd_);
  ::close(event_fd_);
}

void StopSignal::request() noexcept {
  requested_.store(true, std::memory_order_relaxed);
  const std::uint64_t one = 1;
  static_cast<void>(!::write(event_fd_, &one, sizeof one));  // full: the waiting thread is already notified
}

bool StopSignal::poll_for(int milliseconds) noexcept {
  pollfd fds[] = {{signal_fd_, POLLIN, 0}, {event_fd_, POLLIN, 0}};
  if (!requested() && ::poll(fds, 2, milliseconds) > 0) requested_.store(true, std::memory_order_relaxed);
  return requested();
}

bool StopSignal::wait_for(std::chrono::milliseconds time) noexcept {
  return poll_for(static_cast<int>(time.count()));
}

void StopSignal::wait() noexcept {
  while (!poll_for(-1)) {
  }
}

}  // namespace swiftlet::runtime

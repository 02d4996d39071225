#include "swiftlet/services/runtime/periodic_timer.hpp"

#include <cerrno>
#include <ctime>

namespace swiftlet::runtime {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t read(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return read(CLOCK_MONOTONIC); }
std::int64_t system_ns() noexcept { return read(CLOCK_REALTIME); }

PeriodicTimer::PeriodicTimer(std::int64_t period_ns, std::int64_t max_lateness_ns, std::int64_t origin_ns)
    : period_ns_(period_ns), max_lateness_ns_(max_lateness_ns), next_ns_(origin_ns) {
  const std::int64_t passed_ns = monotonic_ns() - origin_ns;
  if (passed_ns > 0) next_ns_ += passed_ns - passed_ns % period_ns;
}

std::int64_t PeriodicTimer::wait() noexcept {
  next_ns_ += period_ns_;
  const timespec next{next_ns_ / kSecond, next_ns_ % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr) == EINTR) {
  }
  const std::int64_t lateness = monotonic_ns() - next_ns_;
  if (lateness <= max_lateness_ns_) return 0;
  const std::int64_t left_out = lateness - lateness % period_ns_;
  next_ns_ += left_out;
  return left_out;
}

}  // namespace swiftlet::runtime

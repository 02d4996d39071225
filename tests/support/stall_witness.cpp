#include "tests/support/stall_witness.hpp"

#include <algorithm>
#include <ctime>
#include <sched.h>

#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::tests {
namespace {

constexpr std::int64_t kLookNs = 250'000;

void sleep_until(std::int64_t time_ns) {
  const timespec until{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
  }
}

}  // namespace

StallWitness::StallWitness(std::int64_t period_ns, int priority)
    : period_ns_(period_ns), priority_(priority) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &allowed)) continue;
    cores_.push_back(std::make_unique<Core>());
    Core& core = *cores_.back();
    core.thread = std::thread([this, &core, cpu] { watch(core, cpu); });
  }
}

StallWitness::~StallWitness() {
  end_ = true;
  for (const auto& core : cores_) core->thread.join();
}

double StallWitness::lost_percent() const {
  double most = 0.0;
  for (const auto& core : cores_) {
    const auto elapsed = static_cast<double>(core->elapsed_ns);
    if (elapsed > 0.0) most = std::max(most, 100.0 * static_cast<double>(core->lost_ns) / elapsed);
  }
  return most;
}

std::int64_t StallWitness::take_longest_ns() {
  std::int64_t longest_ns = 0;
  for (const auto& core : cores_) longest_ns = std::max(longest_ns, core->longest_ns.exchange(0));
  return longest_ns;
}

void StallWitness::watch(Core& core, int cpu) {
  runtime::make_this_thread_realtime({true, priority_, cpu});
  const std::int64_t start_ns = runtime::monotonic_ns();
  for (std::int64_t due_ns = start_ns; !end_; due_ns = runtime::monotonic_ns() + kLookNs) {
    sleep_until(due_ns);
    const std::int64_t now_ns = runtime::monotonic_ns();
    // A sample during a stall is answered at its end: all but those of the last period are late by more than
    // a period.
    core.lost_ns += std::max<std::int64_t>(now_ns - due_ns - period_ns_, 0);
    core.longest_ns = std::max<std::int64_t>(core.longest_ns, now_ns - due_ns);
    core.elapsed_ns = now_ns - start_ns;
  }
}

}  // namespace swiftlet::tests

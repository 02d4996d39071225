#include "swiftlet/ground/flight/interrupts.hpp"

#include <array>
#include <atomic>
#include <csignal>

namespace swiftlet::ground {
namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
std::atomic<int> interrupt_count{0};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<struct sigaction, kSignals.size()> actions_before;

void count_interrupt(int) { interrupt_count.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

Interrupts::Interrupts() {
  interrupt_count = 0;
  struct sigaction action = {};
  action.sa_handler = count_interrupt;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &actions_before[i]);
}

Interrupts::~Interrupts() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &actions_before[i], nullptr);
}

int Interrupts::count() const { return interrupt_count.load(std::memory_order_relaxed); }

}  // namespace swiftlet::ground

#include "swiftlet/services/plant/realtime_loop.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::chrono::microseconds kHandOver{50};

}  // namespace

RealtimeLoop::~RealtimeLoop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void RealtimeLoop::add(RealtimeVehicle& vehicle, std::function<void(const std::string&)> on_fault) {
  const runtime::RealtimeScope scope(realtime_.thread_priority());
  ++waiting_;
  const std::lock_guard<std::mutex> lock(mutex_);
  --waiting_;
  vehicles_.push_back({&vehicle, std::move(on_fault)});
  if (!thread_.joinable())
    thread_ = std::thread([this, period_ns = vehicle.sample_period_ns()] { run(period_ns); });
}

void RealtimeLoop::remove(const RealtimeVehicle& vehicle) {
  const runtime::RealtimeScope scope(realtime_.thread_priority());
  ++waiting_;
  const std::lock_guard<std::mutex> lock(mutex_);
  --waiting_;
  const auto is_removed = [&](const Stepped& stepped) { return stepped.vehicle == &vehicle; };
  vehicles_.erase(std::remove_if(vehicles_.begin(), vehicles_.end(), is_removed), vehicles_.end());
}

void RealtimeLoop::run(std::int64_t period_ns) {
  if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
  runtime::PeriodicTimer timer(period_ns, period_ns);
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::int64_t slipped_ns = timer.wait();
    while (waiting_ > 0) std::this_thread::sleep_for(kHandOver);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Stepped& stepped : vehicles_) step(stepped, timer.tick_ns(), slipped_ns);
  }
}

void RealtimeLoop::step(Stepped& stepped, std::int64_t tick_ns, std::int64_t slipped_ns) {
  if (stepped.faulty) return;
  try {
    if (stepped.begun) return stepped.vehicle->step_to_sample(tick_ns, slipped_ns);
    stepped.begun = true;
    stepped.vehicle->begin(tick_ns);
  } catch (const std::exception& error) {
    stepped.faulty = true;
    stepped.on_fault(error.what());
  }
}

}  // namespace swiftlet::services

// A request on its way through the inner loop and back.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "swiftlet/control/types/request.hpp"

namespace swiftlet::services {

constexpr int kMaxPendingRequests = 32;

struct PendingRequest {
  // Whoever takes it first decides: the inner loop judges it, or nobody did in time.
  enum class State : std::uint8_t { kWaiting, kTaken, kGivenUp };

  std::uint64_t client = 0;
  std::uint64_t id = 0;
  control::Request request;
  std::unique_ptr<control::Mission> mission;  // what request points at
  std::unique_ptr<control::Trajectory> trajectory;
  std::int64_t asked_ns = 0;  // monotonic

  std::atomic<State> state{State::kWaiting};
  control::Outcome outcome;   // of a taken one, written by the inner loop
  std::int64_t stamp_ns = 0;  // likewise: of the last sample before

  // True for one of those who call it.
  bool domain_lock(State as) noexcept {
    State waiting = State::kWaiting;
    return state.compare_exchange_strong(waiting, as, std::memory_order_acq_rel);
  }
};

}  // namespace swiftlet::services

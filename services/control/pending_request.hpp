// A request that the inner loop evaluates and returns.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::services {

constexpr std::size_t kMaxPendingRequests = control::ClientInputs::kMaxRequests;

struct PendingRequest {
  // kTaken: the inner loop evaluates it. kGivenUp: it does not, or did not in time. The first claim()
  // decides.
  enum class State : std::uint8_t { kWaiting, kTaken, kGivenUp };

  std::uint64_t client = 0;
  std::uint64_t id = 0;
  control::Request request;
  std::unique_ptr<control::Mission> mission;  // what `request` points to
  std::unique_ptr<control::Trajectory> trajectory;
  std::unique_ptr<control::GainChange> gains;
  std::int64_t asked_ns = 0;  // monotonic
  bool answered = false;      // a stop that was accepted before the inner loop evaluated it

  std::atomic<State> state{State::kWaiting};
  control::Outcome outcome;   // if kTaken; written by the inner loop
  std::int64_t stamp_ns = 0;  // likewise: of the IMU sample

  // Returns true for the first caller only.
  bool claim(State as) noexcept {
    State waiting = State::kWaiting;
    return state.compare_exchange_strong(waiting, as, std::memory_order_acq_rel);
  }
};

}  // namespace swiftlet::services

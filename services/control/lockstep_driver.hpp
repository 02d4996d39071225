// Lockstep: a sample is answered once all that belongs to it is there, in the thread that received the last of it. This controller is
// active from the first sample on, and must be the only one.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "swiftlet/services/control/lockstep_gate.hpp"
#include "swiftlet/services/control/sample_answers.hpp"
#include "swiftlet/services/control/semaphore.hpp"
#include "swiftlet/services/control/step_driver.hpp"

namespace swiftlet::services {

class LockstepDriver final : public StepDriver {
 public:
  // Posts `wake` when there is a rival. term: of its commands.
  LockstepDriver(std::uint32_t term, SampleAnswers& answers, Semaphore& wake)
      : term_(term), answers_(answers), wake_(wake) {}

  // No sample is answered before the levels are known: the plant sends it again.
  void on_sample(const VehicleSample& sample) override;
  void on_sensor(Stream stream, std::uint64_t sequence, const std::function<void()>& put) override;
  void levels_known() override { levels_known_.store(true, std::memory_order_release); }
  std::uint32_t command_term() const override { return term_; }
  bool has_rival() const override { return rival_.load(std::memory_order_relaxed); }

 private:
  void answer_if_complete();

  const std::uint32_t term_;
  SampleAnswers& answers_;
  Semaphore& wake_;
  std::mutex mutex_;  // guards the gate, the inner loop and its inputs
  LockstepGate gate_;
  std::atomic<bool> levels_known_{false};
  std::atomic<bool> rival_{false};
};

}  // namespace swiftlet::services

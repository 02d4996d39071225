// The samples of the vehicle that control answers, each with a command: of its IMU, or its own estimates in place of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <variant>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::services {

struct VehicleSample {
  std::variant<plant::ImuSample, plant::OdometrySample> motion;
  plant::ObeyedCommand obeyed;
  plant::LockstepInputs lockstep;
  bool of_another_process = false;  // than the sample before

  std::int64_t stamp_ns() const {
    return std::visit([](const auto& sample) { return sample.stamp_ns; }, motion);
  }
  std::uint64_t sequence() const {
    return std::visit([](const auto& sample) { return sample.sequence; }, motion);
  }
};

// A message that is not valid becomes a sample that is not finite: the controller counts those and acts on them.
VehicleSample vehicle_sample(const messages::msg::Imu& message);
VehicleSample vehicle_sample(const messages::msg::VehicleOdometry& message);

// The kind of samples that is answered, if a vehicle sends IMU samples and estimates of its own: the one that was heard first,
// until it has been silent for kSilenceNs. Call from any thread.
class AnsweredSamples {
 public:
  enum class Kind : std::uint8_t { kImu = 1, kOdometry = 2 };

  // True if a sample of this kind, received at now_ns (monotonic), is to be answered.
  bool admit(Kind kind, std::int64_t now_ns) {
    const std::uint8_t before = kind_.load(std::memory_order_relaxed);
    if (before != static_cast<std::uint8_t>(kind)) {
      const bool silent = now_ns - answered_ns_.load(std::memory_order_relaxed) > kSilenceNs;
      if (before != 0 && !silent) {
        refused_ns_.store(now_ns, std::memory_order_relaxed);
        return false;
      }
      kind_.store(static_cast<std::uint8_t>(kind), std::memory_order_relaxed);
    }
    answered_ns_.store(now_ns, std::memory_order_relaxed);
    return true;
  }

  // The topic whose samples are ignored now; nullptr: none.
  const char* ignored(std::int64_t now_ns) const {
    const std::int64_t refused_ns = refused_ns_.load(std::memory_order_relaxed);
    if (refused_ns == 0 || now_ns - refused_ns > kSilenceNs) return nullptr;
    const bool answers_imu = kind_.load(std::memory_order_relaxed) == static_cast<std::uint8_t>(Kind::kImu);
    return answers_imu ? messages::topics::kVehicleOdometry.name : messages::topics::kImu.name;
  }

  static constexpr std::int64_t kSilenceNs = 1'000'000'000;

 private:
  std::atomic<std::uint8_t> kind_{0};  // a Kind; 0: none heard
  std::atomic<std::int64_t> answered_ns_{0};
  std::atomic<std::int64_t> refused_ns_{0};
};

}  // namespace swiftlet::services

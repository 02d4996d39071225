// Sent commands: which of them the vehicle obeyed when it took a sample, and how old it was. Over a link with delay that is not the
// newest one, and a model of the rotors that is compared with the sample has to run on it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

class SentCommands {
 public:
  static constexpr std::size_t kCapacity =
      256;  // 0.256 s at 1 kHz: an older command is not obeyed (docs/vehicle.md)
  static constexpr double kLongestDelay_s = 0.2;  // longer ones count as this
  static constexpr double kMemory_s = 0.3;        // of the mean delay

  // The command that answers the sample of this stamp, and its collective thrust, N. Ignores a stamp that is not newer than the last.
  void sent(std::int64_t stamp_ns, double thrust_n);

  // A sample of this stamp, dt_s > 0 after the last, and what the vehicle reports with it. Without a report the newest command
  // counts as obeyed.
  void sample(std::int64_t stamp_ns, double dt_s, const plant::ObeyedCommand& obeyed);

  // The thrust of the command that the vehicle obeyed at the last sample, N; 0: it obeyed none, or an unknown one.
  double obeyed_thrust_n() const { return obeyed_thrust_n_; }
  // The mean age of the obeyed command, s, which is the delay from a sample to the vehicle that obeys its command; 0: not reported.
  double delay_s() const { return delay_s_; }

 private:
  struct Sent {
    std::int64_t stamp_ns = 0;
    double thrust_n = 0.0;
  };
  const Sent& at(std::size_t i) const { return commands_[(oldest_ + i) % kCapacity]; }

  std::array<Sent, kCapacity> commands_;
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
  double obeyed_thrust_n_ = 0.0;
  double delay_s_ = 0.0;
  bool reported_ = false;
};

}  // namespace swiftlet::control

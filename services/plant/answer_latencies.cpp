#include "swiftlet/services/plant/answer_latencies.hpp"

namespace swiftlet::services {

void AnswerLatencies::written(std::uint64_t imu_sequence, std::int64_t now_ns) {
  Sample& slot = waiting_[imu_sequence % kPatience];
  if (slot.sequence != 0) ++unanswered_;
  slot = {imu_sequence, now_ns};
}

void AnswerLatencies::answered(std::uint64_t imu_sequence, std::int64_t now_ns) {
  Sample& slot = waiting_[imu_sequence % kPatience];
  if (slot.sequence != imu_sequence) return;
  times_.record(now_ns - slot.written_ns);
  if (now_ns - slot.written_ns > late_after_ns_) ++late_;
  slot.sequence = 0;
}

void AnswerLatencies::reset() { *this = AnswerLatencies(late_after_ns_); }

}  // namespace swiftlet::services

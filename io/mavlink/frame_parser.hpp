// Finds the frames in a stream of bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "swiftlet/io/mavlink/frame.hpp"

namespace swiftlet::mavlink {

// After a wrong checksum it looks for the next frame from the second byte of the wrong one on. Frames of messages that
// it does not know cannot be checked, and are skipped as a whole: a start byte within noise may cost the frames of
// the following 280 bytes. Signatures are not verified.
class FrameParser {
 public:
  struct Counts {
    std::uint64_t frames = 0;          // valid
    std::uint64_t unknown = 0;         // frames of other messages
    std::uint64_t wrong_checksum = 0;  // frames
    std::uint64_t skipped = 0;         // bytes that belong to no frame
  };

  // Calls on_frame(const Frame&) for each valid frame that ends within the bytes.
  template <class OnFrame>
  void feed(const std::uint8_t* bytes, std::size_t size, OnFrame&& on_frame) {
    for (std::size_t i = 0; i < size; ++i) {
      buffer_[size_++] = bytes[i];
      for (Step step = take(); step != Step::kWait; step = take()) {
        if (step == Step::kFrame) on_frame(frame_);
      }
    }
  }

  const Counts& counts() const { return counts_; }
  void reset() { size_ = 0; }  // forgets a frame that has begun

 private:
  enum class Step { kWait, kDropped, kFrame };

  Step take();  // at most one frame from the start of the buffer
  Step drop(std::size_t size);

  std::array<std::uint8_t, kLongestFrame> buffer_{};
  std::size_t size_ = 0;
  Frame frame_;
  Counts counts_;
};

}  // namespace swiftlet::mavlink

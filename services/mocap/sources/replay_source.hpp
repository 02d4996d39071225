// Plays a recording in real time: captured traffic of a NatNet server, or a table of poses.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/mocap/capture_file.hpp"
#include "swiftlet/services/mocap/sources/natnet_session.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"

namespace swiftlet::mocap {

// A file of pcap or pcapng, or a CSV with the columns t, x, y, z, qx, qy, qz, qw (s, m), whose only body has the name of the file
// and the number 0. Begins with the first receive(). Frames are as far apart as recorded.
class ReplaySource final : public Source {
 public:
  // Throws ConfigError if the file cannot be read or has no frame.
  explicit ReplaySource(const Room& room);

  bool receive(SourceFrame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;
  bool has_ended() const override { return next_ == recorded_.size(); }

 private:
  struct Recorded {
    std::int64_t arrived_ns = 0;  // from the first on
    std::int64_t exposed_ns = 0;
    std::vector<BodyPose> poses;
  };

  void read_capture(const std::string& text, const std::string& file, const std::string& server);
  void read_table(const std::string& text, const std::string& file);
  void add_frame(const NatNetSession& session, std::int64_t arrived_ns);

  const std::string file_;
  const std::int64_t latency_ns_;
  std::vector<Recorded> recorded_;
  std::size_t next_ = 0;
  std::optional<std::int64_t> start_ns_;
};

}  // namespace swiftlet::mocap

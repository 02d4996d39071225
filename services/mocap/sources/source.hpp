// Where poses come from: the server of a motion capture, or a recording.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/io/mocap/room.hpp"

namespace swiftlet::mocap {

// A body that the server knows. A system without numbers has 0 everywhere, one without names a name for each number.
struct Body {
  std::string name;
  std::int32_t id = 0;
};

struct BodyPose {
  std::size_t body = 0;  // in Source::bodies()
  bool tracked = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, in the axes of the motion capture
  Eigen::Quaterniond q_room_from_body = Eigen::Quaterniond::Identity();
  int markers = 0;  // 0: not told
  int lost_markers = 0;
};

// What arrived at once. Times are of the monotonic clock of this host.
struct SourceFrame {
  std::int64_t arrived_ns = 0;
  std::optional<std::int64_t> exposed_ns;  // nullopt: the server's clock is not known yet, or was just set
  bool is_complete = true;                 // a body that is not in it is not tracked
  std::vector<BodyPose> poses;
};

struct SourceStatistics {
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;       // by their numbers
  std::uint64_t late = 0;       // behind a newer one, or twice; left out
  std::uint64_t refused = 0;    // datagrams that could not be read
  std::uint64_t strangers = 0;  // datagrams of other servers; left out
  std::uint64_t restarts = 0;   // of the server, or connections to it that were lost
  std::string last_refusal;     // a sentence
};

class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // Waits for the next frame, and keeps the connection alive meanwhile. Returns false after the timeout. A server that is
  // silent or gone is no error: it is asked again. Throws std::runtime_error for what does not heal by itself, such as a
  // version that is not supported.
  virtual bool receive(SourceFrame& frame, std::chrono::milliseconds timeout) = 0;

  // "Motive 2.1 (NatNet 3.0) at 192.168.0.106"; says so if nobody has answered yet.
  virtual std::string description() const = 0;
  // A recording has been played.
  virtual bool has_ended() const { return false; }

  const std::vector<Body>& bodies() const { return bodies_; }
  // Changes with bodies().
  std::uint64_t revision() const { return revision_; }
  const SourceStatistics& statistics() const { return statistics_; }

 protected:
  void set_bodies(std::vector<Body> bodies);
  // Its index in bodies(); adds it if it is new. nullopt: there are too many.
  std::optional<std::size_t> body_of(const std::string& name, std::int32_t id);
  void refuse(const std::string& why);

  SourceStatistics statistics_;

 private:
  std::vector<Body> bodies_;
  std::uint64_t revision_ = 0;
};

// The index of a vehicle's body. nullopt: the server does not have it.
std::optional<std::size_t> find_body(const std::vector<Body>& bodies, const VehicleBody& vehicle);
// "kl1 (1), kl2 (2)"; "none".
std::string to_string(const std::vector<Body>& bodies);

// Throws std::invalid_argument for an address or interface that is none, std::runtime_error if a port cannot be opened or if
// several servers answer and the room names none.
std::unique_ptr<Source> open_source(const Room& room);

}  // namespace swiftlet::mocap

// What the ground tool keeps of a flight: every sample of the telemetry, in storage that was made before the
// flight.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace swiftlet::ground {

struct TruthRow {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> position_ned{};    // m
  std::array<double, 3> velocity_ned{};    // m/s
  std::array<double, 4> q_ned_from_frd{};  // w, x, y, z
  std::array<double, 3> body_rates_frd{};  // rad/s
  std::array<double, 8> rotor_speeds{};    // rad/s
  int rotor_count = 0;
  double supply_voltage_v = 0.0;
  bool on_ground = false;
};

struct ReferenceRow {
  std::int64_t stamp_ns = 0;
  int mode = 0;  // ControlStatus_Constants::MODE_*
  std::array<double, 3> position_ned{};
  std::array<double, 3> velocity_ned{};
  double yaw_rad = 0.0;
};

struct EstimateRow {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> position_ned{};
  std::array<double, 3> velocity_ned{};
};

struct MissionRow {
  std::int64_t stamp_ns = 0;
  std::uint64_t mission_id = 0;
  int state = 0;  // MissionStatus_Constants
  std::uint32_t item_index = 0;
};

// Rows in the order in which they came: one thread appends and never waits, any thread reads those that are
// in.
template <class Row>
class Track {
 public:
  explicit Track(std::size_t capacity) : rows_(std::make_unique<Row[]>(capacity)), capacity_(capacity) {}

  void append(const Row& row) noexcept {
    const std::size_t at = size_.load(std::memory_order_relaxed);
    if (at == capacity_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    rows_[at] = row;
    size_.store(at + 1, std::memory_order_release);
  }

  void clear() noexcept {  // for another flight; while nobody reads
    size_.store(0, std::memory_order_release);
    dropped_.store(0, std::memory_order_relaxed);
  }

  std::size_t size() const { return size_.load(std::memory_order_acquire); }
  std::size_t dropped() const { return dropped_.load(std::memory_order_relaxed); }  // came when it was full
  bool empty() const { return size() == 0; }
  const Row& operator[](std::size_t i) const { return rows_[i]; }
  const Row& back() const { return rows_[size() - 1]; }
  const Row* begin() const { return rows_.get(); }
  const Row* end() const { return rows_.get() + size(); }

 private:
  std::unique_ptr<Row[]> rows_;
  std::size_t capacity_;
  std::atomic<std::size_t> size_{0};
  std::atomic<std::size_t> dropped_{0};
};

struct FlightRecord {
  // capacity: of each track
  explicit FlightRecord(std::size_t capacity)
      : truth(capacity), reference(capacity), estimate(capacity), mission(capacity) {}

  void clear() noexcept {
    truth.clear();
    reference.clear();
    estimate.clear();
    mission.clear();
  }

  Track<TruthRow> truth;
  Track<ReferenceRow> reference;
  Track<EstimateRow> estimate;
  Track<MissionRow> mission;
};

// Stamps from which and up to which (not included) errors are taken.
struct Window {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;

  double duration_s() const { return static_cast<double>(to_ns - from_ns) * 1e-9; }
};

}  // namespace swiftlet::ground

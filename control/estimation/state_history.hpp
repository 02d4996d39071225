// The nominal path of the estimator over the last half second: the states at the IMU samples since the anchor, the state up to which
// the poses have corrected it. A correction at the anchor is carried to the present without propagating the samples again.
//
// Of most states only the stamp is ever read. So a correction changes the anchor and the newest state at once, and the others when
// they are read.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/error_covariance.hpp"

namespace swiftlet::control {

struct NominalState {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
};

// Does not allocate.
class StateHistory {
 public:
  static constexpr int kCapacity = 256;  // IMU samples: 0.5 s at 500 Hz

  const NominalState& newest() const { return newest_; }
  const NominalState& anchor() const { return anchor_; }

  // The state at a sample newer than the last. Once the path has begun, call make_room() before.
  void append(const NominalState& state);
  // Forgets all states but the newest one.
  void clear() { next_ = 0; }

  // Begins the path at this state, which is not newer than the newest one and becomes the anchor: the states since are turned and
  // moved with it, and it is taken to be in free fall but for the specific force since.
  void begin_at(const NominalState& start);

  // Applies an error-state step at the anchor to the states there and since: F of error_covariance.hpp, with the attitude step as a
  // rotation.
  void apply(const ErrorState& step);

  // Moves the anchor to the state at a stamp not before it, between two samples too, at most to the newest. Calls
  // visit(const ErrorInterval&) for each interval on the way, by which the covariance is to be propagated.
  template <class Visit>
  void move_anchor(std::int64_t stamp_ns, Visit&& visit) {
    move_anchor(place_at(stamp_ns), visit);
  }
  // The same, and only if the states since the anchor fill the history.
  template <class Visit>
  void make_room(Visit&& visit) {
    if (next_ - first_after_anchor_ < kCapacity - kIntervalEntries) return;
    const std::uint64_t number = first_after_anchor_ + kIntervalEntries / 2;
    move_anchor(Place{state(number), number + 1}, visit);
  }
  // Visits the intervals from the anchor to the newest state.
  template <class Visit>
  void for_each_interval(Visit&& visit) const {
    for_each_interval({newest_, next_}, visit);
  }

 private:
  static constexpr std::uint64_t kIntervalEntries = 32;  // at most in one interval
  static constexpr std::uint64_t kCorrections = 32;

  struct Entry {
    NominalState state;
    std::uint64_t corrections = 0;  // number of corrections that it includes
  };
  // A state on the path, and the number of the first entry after it.
  struct Place {
    NominalState state;
    std::uint64_t next = 0;
  };
  // A correction of the error state at one time, and its effect on the states before and after.
  struct Correction {
    NominalState at;  // the state before the correction
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();          // subtracted from the rotation's rate
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // subtracted from the velocity's rate
    void apply_to(NominalState& state) const;
  };

  template <class Visit>
  void for_each_interval(const Place& to, Visit&& visit) const {
    Place from{anchor_, first_after_anchor_};
    while (from.state.stamp_ns != to.state.stamp_ns) {
      const Place next = next_place(from, to);
      visit(interval(from.state, next.state));
      from = next;
    }
  }
  template <class Visit>
  void move_anchor(const Place& place, Visit&& visit) {
    for_each_interval(place, visit);
    anchor_ = place.state;
    first_after_anchor_ = place.next;
  }

  static ErrorInterval interval(const NominalState& from, const NominalState& to);
  const Entry& entry(std::uint64_t number) const { return entries_[number % kCapacity]; }
  std::int64_t stamp_ns(std::uint64_t number) const { return entry(number).state.stamp_ns; }
  NominalState state(std::uint64_t number) const;  // with all corrections
  std::uint64_t first_newer_than(std::int64_t stamp_ns) const;
  Place place_at(std::int64_t stamp_ns) const;
  Place next_place(const Place& from, const Place& to) const;
  void correct_entries();

  NominalState newest_;
  NominalState anchor_;
  std::uint64_t first_after_anchor_ = 0;  // number of an entry

  std::array<Entry, kCapacity> entries_;
  std::uint64_t next_ = 0;  // number of the next entry
  std::array<Correction, kCorrections> corrections_;
  std::uint64_t corrections_made_ = 0;
};

}  // namespace swiftlet::control

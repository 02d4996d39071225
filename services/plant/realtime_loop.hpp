// Steps the simulated vehicles of a process at the computer's pace, one after another in one thread: waking a core takes longer
// than the steps of a vehicle.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/services/plant/realtime_vehicle.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

class RealtimeLoop {
 public:
  explicit RealtimeLoop(const runtime::RealtimeSettings& realtime) : realtime_(realtime) {}
  ~RealtimeLoop();
  RealtimeLoop(const RealtimeLoop&) = delete;
  RealtimeLoop& operator=(const RealtimeLoop&) = delete;

  // All vehicles have the sample period of the first. on_fault: called in the thread of the loop with the text of an exception; the
  // vehicle is stepped no more then.
  void add(RealtimeVehicle& vehicle, std::function<void(const std::string&)> on_fault);
  // Waits for a running step. No effect if the vehicle was not added.
  void remove(const RealtimeVehicle& vehicle);

 private:
  struct Stepped {
    RealtimeVehicle* vehicle;
    std::function<void(const std::string&)> on_fault;
    bool begun = false;
    bool faulty = false;
  };

  // If it falls behind by more than a sample period, it delays simulated time by whole periods instead of catching up: a burst of
  // samples could not be answered.
  void run(std::int64_t period_ns);
  static void step(Stepped& stepped, std::int64_t tick_ns, std::int64_t slipped_ns);

  const runtime::RealtimeSettings realtime_;
  std::mutex mutex_;  // guards vehicles_; held while they step
  std::atomic<int> waiting_{
      0};  // threads that wait for mutex_: a loop that is late would not let them have it
  std::vector<Stepped> vehicles_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::services

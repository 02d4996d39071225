// Serves several vehicles in one process, so that one that fails ends alone.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/services/runtime/stop_signal.hpp"

namespace swiftlet::runtime {

class HostedVehicle {
 public:
  explicit HostedVehicle(std::string name) : name_(std::move(name)) {}
  virtual ~HostedVehicle() = default;  // withdraws the vehicle from the network
  HostedVehicle(const HostedVehicle&) = delete;
  HostedVehicle& operator=(const HostedVehicle&) = delete;

  // Serves the vehicle, in a thread of its own, until `stop`, or returns if other threads do. An exception is a failure.
  virtual void run(const std::atomic<bool>& stop) = 0;
  // Work of the main thread, which has normal priority: each period, and once when run() has returned. An exception
  // is a failure.
  virtual void attend() {}
  // Whether what serves the vehicle goes on; if it hangs, so that no exception comes, the service manager is to end the process.
  virtual bool goes_on() const { return true; }
  // Logs what was done, once run() has returned without a failure.
  virtual void log_end() {}

  // Ends this vehicle; the first sentence is kept. Call from any thread.
  void fail(const std::string& sentence);
  std::string failure() const;  // empty: none

  const std::string& name() const { return name_; }

 private:
  const std::string name_;
  mutable std::mutex mutex_;  // guards failure_
  std::string failure_;
};

// Runs the vehicles, each in a thread of its own, until a stop is requested or all have failed. One that fails is logged
// and destroyed, the others go on. Tells the service manager that the process is ready, and that it stops; feeds its watchdog while
// all vehicles go on. Throws std::runtime_error at the end if any failed, with the sentences.
void host(std::vector<std::unique_ptr<HostedVehicle>> vehicles, StopSignal& stop,
          std::chrono::milliseconds period);

// The label of the log lines of a vehicle: its name where a process serves several, else empty.
std::string log_label_of(const std::string& vehicle, std::size_t vehicles);

}  // namespace swiftlet::runtime

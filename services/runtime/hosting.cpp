#include "swiftlet/services/runtime/hosting.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "swiftlet/io/text.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/service_manager.hpp"

namespace swiftlet::runtime {
namespace {

// A hosted vehicle and its thread.
class Running {
 public:
  Running(std::unique_ptr<HostedVehicle> vehicle, std::size_t vehicles)
      : vehicle_(std::move(vehicle)), label_(log_label_of(vehicle_->name(), vehicles)), thread_([this] {
          const LogLabel label(label_);
          guarded([this] { vehicle_->run(stop_); });
        }) {}
  ~Running() { join(); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  bool has_failed() const { return !vehicle_->failure().empty(); }
  std::string failure() const { return (label_.empty() ? "" : label_ + ": ") + vehicle_->failure(); }

  void attend() {
    const LogLabel label(label_);
    guarded([this] { vehicle_->attend(); });
  }

  bool goes_on() const { return vehicle_->goes_on(); }

  void request_stop() { stop_ = true; }

  void end() {
    join();
    attend();
    const LogLabel label(label_);
    if (!has_failed()) guarded([this] { vehicle_->log_end(); });
  }

 private:
  template <class Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (const std::exception& error) {
      vehicle_->fail(error.what());
    }
  }

  void join() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  std::unique_ptr<HostedVehicle> vehicle_;
  const std::string label_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: uses all members above
};

using Fleet = std::vector<std::unique_ptr<Running>>;

// Takes the vehicles that have failed out of the fleet.
Fleet take_failed(Fleet& fleet) {
  const auto first =
      std::stable_partition(fleet.begin(), fleet.end(), [](const auto& one) { return !one->has_failed(); });
  Fleet failed(std::make_move_iterator(first), std::make_move_iterator(fleet.end()));
  fleet.erase(first, fleet.end());
  return failed;
}

}  // namespace

void HostedVehicle::fail(const std::string& sentence) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failure_.empty()) failure_ = sentence;
}

std::string HostedVehicle::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

std::string log_label_of(const std::string& vehicle, std::size_t vehicles) {
  return vehicles > 1 ? vehicle : std::string();
}

void host(std::vector<std::unique_ptr<HostedVehicle>> vehicles, StopSignal& stop,
          std::chrono::milliseconds period) {
  const std::size_t count = vehicles.size();
  Fleet fleet;
  fleet.reserve(count);
  for (auto& vehicle : vehicles) fleet.push_back(std::make_unique<Running>(std::move(vehicle), count));
  std::vector<std::string> failures;
  Watchdog watchdog;
  notify_service_manager("READY=1");
  do {
    for (const auto& one : fleet) one->attend();
    for (const auto& one : take_failed(fleet)) {
      failures.push_back(one->failure());
      if (count > 1) runtime::log_error("{}; this vehicle ends, {} go on", failures.back(), fleet.size());
    }
    if (std::all_of(fleet.begin(), fleet.end(), [](const auto& one) { return one->goes_on(); }))
      watchdog.feed();
  } while (!fleet.empty() && !stop.wait_for(period));
  notify_service_manager("STOPPING=1");
  for (const auto& one : fleet) one->request_stop();
  for (const auto& one : fleet) one->end();
  for (const auto& one : take_failed(fleet)) failures.push_back(one->failure());
  if (failures.empty()) return;
  if (count == 1) throw std::runtime_error(failures.front());
  throw std::runtime_error(std::to_string(failures.size()) + " of " + std::to_string(count) +
                           " vehicles failed: " + io::joined(failures, "; "));
}

}  // namespace swiftlet::runtime

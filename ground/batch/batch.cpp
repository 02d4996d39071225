#include "swiftlet/ground/batch/batch.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/plant/model/battery.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod{100};

double elapsed_s(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double supply_voltage_v(const simulation::World& world) {
  return plant::open_circuit_voltage(world.vehicle.battery, world.simulation.supply.initial_state_of_charge);
}

// The threads of a batch, of which each takes the next run.
class WorkerPool {
 public:
  using Fly = std::function<std::optional<BatchRun>(std::size_t index)>;

  WorkerPool(std::size_t runs, Fly fly) : fly_(std::move(fly)), results_(runs) {}

  void work(std::size_t jobs, const std::function<void(std::size_t done, std::size_t failed)>& progress) {
    std::vector<std::thread> threads;
    threads.reserve(jobs);
    for (std::size_t i = 0; i < jobs; ++i) {
      const std::lock_guard<std::mutex> lock(mutex_);
      try {
        threads.emplace_back([this] { run(); });
        ++busy_;
      } catch (const std::exception&) {  // the system starts no more
        if (threads.empty()) throw;
        break;
      }
    }
    {
      std::unique_lock<std::mutex> lock(mutex_);
      while (!changed_.wait_for(lock, kProgressPeriod, [this] { return busy_ == 0; }))
        progress(done_, failed_);
      progress(done_, failed_);
    }
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
  }

  std::vector<BatchRun> take_results() {
    std::vector<BatchRun> runs;
    for (std::optional<BatchRun>& result : results_) {
      if (result) runs.push_back(std::move(*result));
    }
    return runs;
  }

 private:
  void run() {
    try {
      while (fly_next()) {
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!error_) error_ = std::current_exception();
      next_ = results_.size();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    --busy_;
    changed_.notify_one();
  }

  bool fly_next() {
    const std::size_t index = next_.fetch_add(1);
    if (index >= results_.size()) return false;
    std::optional<BatchRun> result = fly_(index);
    if (!result) return false;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++done_;
    if (!result->completed) ++failed_;
    results_[index] = std::move(result);
    return true;
  }

  const Fly fly_;
  std::vector<std::optional<BatchRun>> results_;
  std::atomic<std::size_t> next_{0};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t busy_ = 0;
  std::size_t done_ = 0;
  std::size_t failed_ = 0;
  std::exception_ptr error_;
};

}  // namespace

std::size_t Batch::failed() const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const BatchRun& run) { return !run.completed; }));
}

BatchRunner::BatchRunner(LaunchConfiguration plan, std::size_t runs)
    : plan_(std::move(plan)), runs_(runs), design_(control::design(plan_.vehicle, plan_.control)) {
  const control::FlightController flyable(plan_.vehicle, plan_.control);
  for (std::size_t i = 0; i < runs_; ++i)
    rejected_ += static_cast<std::size_t>(draw(plan_, plan_.seed + i).rejected);
}

Batch BatchRunner::fly(std::size_t jobs, const std::function<bool()>& cancelled,
                       const std::function<void(const BatchProgress&)>& progress) const {
  if (jobs < 1 || jobs > kMostJobs)
    throw std::invalid_argument("jobs is " + std::to_string(jobs) + ", must be from 1 to " +
                                std::to_string(kMostJobs));
  const auto start = std::chrono::steady_clock::now();
  const auto fly_one = [&](std::size_t index) -> std::optional<BatchRun> {
    if (cancelled()) return std::nullopt;
    const std::uint64_t seed = plan_.seed + index;
    simulation::DispersionSample drawn = draw(plan_, seed);
    simulation::ClosedLoop loop = closed_loop(plan_, drawn.world, seed);
    record::Flight flight;
    const analysis::FlightReport report = fly_in_process(loop, plan_, seed, flight, nullptr, cancelled);
    if (!report.completed && cancelled()) return std::nullopt;
    return BatchRun{seed,
                    report.completed,
                    report.reason,
                    report.errors.rms_3d_m,
                    report.errors.peak_3d_m,
                    report.duration_s,
                    margins_on(design_, plan_.vehicle, drawn.world.vehicle, supply_voltage_v(drawn.world)),
                    std::move(drawn.values)};
  };

  WorkerPool pool(runs_, fly_one);
  pool.work(std::min(jobs, runs_), [&](std::size_t done, std::size_t failed) {
    progress({runs_, done, failed, elapsed_s(start)});
  });

  Batch batch;
  batch.requested = runs_;
  batch.runs = pool.take_results();
  batch.rejected = rejected_;
  batch.designed_deg =
      margins_on(design_, plan_.vehicle, plan_.vehicle, supply_voltage_v({plan_.vehicle, plan_.simulation}));
  batch.wall_s = elapsed_s(start);
  return batch;
}

}  // namespace swiftlet::ground

// Many environments that take their steps together, on several threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "swiftlet/simulation/hover_environment.hpp"

namespace swiftlet::simulation {

// The results do not depend on the number of threads. One thread calls it.
class VectorEnvironment {
 public:
  static constexpr std::size_t kMostThreads = 1024;

  // count: at least 1. threads: 1 .. kMostThreads, else throws std::invalid_argument; fewer if the system starts no more. Further
  // arguments and exceptions as of HoverEnvironment.
  VectorEnvironment(const World& nominal, const HoverTask& task, const Dispersion& dispersion,
                    std::size_t count, std::size_t threads);
  ~VectorEnvironment();
  VectorEnvironment(
      const VectorEnvironment& other);  // with the state of its episodes, and threads of its own
  VectorEnvironment& operator=(const VectorEnvironment&) = delete;

  std::size_t count() const { return environments_.size(); }
  std::size_t observation_size() const { return observation_size_; }
  const ActionBounds& bounds() const { return environments_.front().bounds(); }

  // Begins the first episode of a seed for each environment, or the next one of its seed. seeds: count() of them, or null.
  // chosen: count() flags, which environments; null: all.
  void reset(const std::uint64_t* seeds = nullptr, const bool* chosen = nullptr);

  // Row by row in the order of the environments; all but `actions` and `chosen` are outputs.
  struct Step {
    const double* actions = nullptr;       // count() x bounds().low.size(), all finite
    double* observations = nullptr;        // count() x observation_size()
    double* rewards = nullptr;             // count()
    bool* terminated = nullptr;            // count()
    bool* truncated = nullptr;             // count()
    double* final_observations = nullptr;  // as observations; where an episode ended, its last one, else 0
    const bool* chosen = nullptr;  // count(): others are only observed, and rewarded with 0; null: all
  };
  // An environment whose episode ends begins the next one within the step: its row of `observations` is the first of
  // that. Call reset(seeds) before. Throws as draw() does.
  void step(const Step& step);

  void observe(double* observations) const;

 private:
  void start_threads(std::size_t parts);
  void step(std::size_t index, const Step& step);
  void for_all(const std::function<void(std::size_t index)>& use);
  void run_part(std::size_t part);
  void work(std::size_t part);

  std::vector<HoverEnvironment> environments_;
  std::size_t observation_size_;

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  const std::function<void(std::size_t index)>* use_ = nullptr;
  std::uint64_t round_ = 0;  // counts the calls of for_all()
  std::size_t busy_ = 0;     // threads that have not finished this round
  bool ends_ = false;
  std::exception_ptr error_;
  std::size_t parts_;
  std::vector<std::thread> threads_;  // of the parts from 1 on; part 0 is done by the caller
};

}  // namespace swiftlet::simulation

#include "swiftlet/simulation/vector_environment.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

namespace swiftlet::simulation {

VectorEnvironment::VectorEnvironment(const World& nominal, const HoverTask& task,
                                     const Dispersion& dispersion, std::size_t count, std::size_t threads)
    : observation_size_(static_cast<std::size_t>(HoverEnvironment::observation_size(nominal.vehicle))),
      parts_(1) {
  if (threads < 1 || threads > kMostThreads)
    throw std::invalid_argument("threads is " + std::to_string(threads) + ", must be from 1 to " +
                                std::to_string(kMostThreads));
  environments_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) environments_.emplace_back(nominal, task, dispersion);
  start_threads(std::min(count, threads));
}

VectorEnvironment::VectorEnvironment(const VectorEnvironment& other)
    : environments_(other.environments_), observation_size_(other.observation_size_), parts_(1) {
  start_threads(other.parts_);
}

void VectorEnvironment::start_threads(std::size_t parts) {
  threads_.reserve(parts - 1);
  try {
    for (; parts_ < parts; ++parts_) threads_.emplace_back([this, part = parts_] { work(part); });
  } catch (const std::exception&) {  // the system starts no more
  }
}

VectorEnvironment::~VectorEnvironment() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void VectorEnvironment::reset(const std::uint64_t* seeds, const bool* chosen) {
  for_all([&](std::size_t i) {
    if (chosen != nullptr && !chosen[i]) return;
    seeds == nullptr ? environments_[i].reset() : environments_[i].reset(seeds[i]);
  });
}

void VectorEnvironment::step(const Step& step) {
  for_all([&](std::size_t i) { this->step(i, step); });
}

void VectorEnvironment::step(std::size_t index, const Step& step) {
  HoverEnvironment& environment = environments_[index];
  double* const observation = step.observations + index * observation_size_;
  double* const last = step.final_observations + index * observation_size_;
  const bool steps = step.chosen == nullptr || step.chosen[index];
  const auto outcome =
      !steps ? HoverEnvironment::Outcome() : environment.step(step.actions + index * bounds().low.size());
  step.rewards[index] = outcome.reward;
  step.terminated[index] = outcome.terminated;
  step.truncated[index] = outcome.truncated;
  if (outcome.terminated || outcome.truncated) {
    environment.observe(last);
    environment.reset();
  } else {
    std::fill_n(last, observation_size_, 0.0);
  }
  environment.observe(observation);
}

void VectorEnvironment::observe(double* observations) const {
  for (std::size_t i = 0; i < environments_.size(); ++i)
    environments_[i].observe(observations + i * observation_size_);
}

void VectorEnvironment::for_all(const std::function<void(std::size_t index)>& use) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    use_ = &use;
    busy_ = parts_ - 1;
    ++round_;
  }
  changed_.notify_all();
  run_part(0);
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return busy_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

// The environments of a part are next to each other.
void VectorEnvironment::run_part(std::size_t part) {
  try {
    const std::size_t count = environments_.size();
    for (std::size_t i = count * part / parts_; i < count * (part + 1) / parts_; ++i) (*use_)(i);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

void VectorEnvironment::work(std::size_t part) {
  std::uint64_t done = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ends_ || round_ != done; });
    if (ends_) return;
    done = round_;
    lock.unlock();
    run_part(part);
    lock.lock();
    if (--busy_ == 0) changed_.notify_all();
  }
}

}  // namespace swiftlet::simulation

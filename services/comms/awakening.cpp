#include "services/comms/awakening.hpp"

#include <utility>

namespace swiftlet::comms {

Awakening::Awakening(std::chrono::milliseconds absence, OnReturn on_return)
    : absence_(absence), on_return_(std::move(on_return)), thread_([this] { watch(); }) {}

Awakening::~Awakening() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void Awakening::watch() {
  std::chrono::milliseconds away{0};
  auto last = std::chrono::steady_clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_.wait_for(lock, absence_ / kLooks, [this] { return end_; })) {
    const auto elapsed =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - last);
    if (elapsed > absence_) away = elapsed;
    if (away.count() > 0) {
      lock.unlock();
      if (on_return_(away)) away = std::chrono::milliseconds(0);
      lock.lock();
    }
    last = std::chrono::steady_clock::now();
  }
}

}  // namespace swiftlet::comms

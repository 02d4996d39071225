#include "swiftlet/services/mocap/frame_thread.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace swiftlet::services {
namespace {

constexpr std::chrono::milliseconds kLongestWait{20};

}  // namespace

FrameThread::FrameThread(std::unique_ptr<mocap::Source> source, const runtime::RealtimeSettings& realtime,
                         std::function<void()> on_end)
    : source_(std::move(source)), realtime_(realtime), on_end_(std::move(on_end)) {}

FrameThread::~FrameThread() { stop(); }

void FrameThread::add(FrameTaker& taker) {
  const std::lock_guard<std::mutex> lock(mutex_);
  takers_.push_back(&taker);
}

void FrameThread::remove(FrameTaker& taker) {
  const std::lock_guard<std::mutex> lock(mutex_);
  takers_.erase(std::remove(takers_.begin(), takers_.end(), &taker), takers_.end());
}

void FrameThread::start() {
  thread_ = std::thread([this] { run(); });
}

void FrameThread::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void FrameThread::run() {
  runtime::RealtimeThread realtime;
  realtime.enter(realtime_);
  try {
    while (!stop_ && !source_->has_ended()) {
      receive();
      pulse_.beat();
    }
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (FrameTaker* const taker : takers_) taker->end(error.what());
    return;
  }
  if (!stop_) on_end_();
}

void FrameThread::receive() {
  const bool has_frame = source_->receive(frame_, kLongestWait);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (FrameTaker* const taker : takers_) {
    if (has_frame) {
      taker->take(frame_, *source_);
    } else {
      taker->wait_for_frame();
    }
  }
}

}  // namespace swiftlet::services

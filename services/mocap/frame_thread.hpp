// Receives the frames of a motion capture for all vehicles of a room.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/services/mocap/sources/source.hpp"
#include "swiftlet/services/runtime/realtime.hpp"
#include "swiftlet/services/runtime/service_manager.hpp"

namespace swiftlet::services {

class FrameTaker {
 public:
  virtual void take(const mocap::SourceFrame& frame, const mocap::Source& source) = 0;
  // Called some 50 times per second while no frame comes.
  virtual void wait_for_frame() = 0;
  // No frame will come any more.
  virtual void end(const std::string& why) = 0;

 protected:
  ~FrameTaker() = default;
};

class FrameThread {
 public:
  // on_end: called in the thread after a recording has been played.
  FrameThread(std::unique_ptr<mocap::Source> source, const runtime::RealtimeSettings& realtime,
              std::function<void()> on_end);
  ~FrameThread();
  FrameThread(const FrameThread&) = delete;
  FrameThread& operator=(const FrameThread&) = delete;

  // Thread-safe. After remove() has returned the taker is not called any more.
  void add(FrameTaker& taker);
  void remove(FrameTaker& taker);

  // Call both when every taker has been added, and after the last has been removed.
  void start();
  void stop();
  bool goes_on() const { return pulse_.beats(); }  // Call from any thread.
  // Call only before start() and after stop().
  const mocap::Source& source() const { return *source_; }

 private:
  void run();
  void receive();

  const std::unique_ptr<mocap::Source> source_;
  const runtime::RealtimeSettings realtime_;
  const std::function<void()> on_end_;
  std::mutex mutex_;  // guards takers_
  std::vector<FrameTaker*> takers_;
  mocap::SourceFrame frame_;
  std::atomic<bool> stop_{false};
  runtime::Pulse pulse_;
  std::thread thread_;
};

}  // namespace swiftlet::services

// Names the participants that the authentication plugin refuses, and why, in the log.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// Fast DDS reports whom it refuses by GUID only, several times for one participant, and writes the reason to its own
// log, from another thread. Thread-safe.
class RefusedPeers {
 public:
  using Guid = rtps::GUID_t;
  using Time = std::chrono::steady_clock::time_point;

  RefusedPeers();  // begins to listen to the log of Fast DDS
  ~RefusedPeers();
  RefusedPeers(const RefusedPeers&) = delete;
  RefusedPeers& operator=(const RefusedPeers&) = delete;

  // peer: "ground (process 12 on host lab2)", as it announces itself, which nothing proves. reason: ": why", unless Fast DDS
  // logged another one. Empty: Fast DDS refuses it; then call this in the thread in which it says so.
  void note(const Guid& guid, const std::string& peer, const char* reason, Time now);
  // Logs those of more than kReasonTime ago, each at most once in kRepeatTime, and all together at most kMostLines in that
  // time.
  void write_due(Time now);

  static constexpr std::chrono::milliseconds kReasonTime{300};
  static constexpr std::chrono::seconds kRepeatTime{10};
  static constexpr std::size_t kMostLines = 16;

 private:
  struct Refusal {
    std::string peer;
    const char* reason;
    Time at;
  };

  std::mutex mutex_;
  std::map<Guid, Refusal> due_;
  std::map<Guid, Time> written_;
};

}  // namespace swiftlet::comms

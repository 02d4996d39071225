#include "swiftlet/services/runtime/hosting.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/log_text.hpp"

namespace swiftlet::runtime::hosting_test {

using namespace std::chrono_literals;
using tests::LogText;

// What the test sees of a vehicle that has been destroyed.
struct Trace {
  std::atomic<int> steps{0};
  std::atomic<int> attended{0};
  std::atomic<bool> logged_end{false};
  std::atomic<bool> destroyed{false};
  std::atomic<bool> released{false};  // lets a vehicle go on that blocks
};

// Steps until the stop, and fails where it is told to.
class SteppingVehicle final : public HostedVehicle {
 public:
  enum class Fault { kNone, kRunThrows, kAttendThrows, kReported, kFailsAtOnce, kStopThrows, kBlocks };

  SteppingVehicle(const std::string& name, Trace& trace, Fault fault)
      : HostedVehicle(name), trace_(trace), fault_(fault) {
    if (fault == Fault::kFailsAtOnce) fail("it cannot start");
  }
  ~SteppingVehicle() override { trace_.destroyed = true; }

  void run(const std::atomic<bool>& stop) override {
    while (fault_ == Fault::kBlocks && !trace_.released) std::this_thread::yield();
    while (!stop) {
      if (++trace_.steps < kGoodSteps) continue;
      if (fault_ == Fault::kRunThrows) throw std::runtime_error("its step failed");
      if (fault_ == Fault::kReported) fail("its callback failed");
      std::this_thread::yield();
    }
    if (fault_ == Fault::kStopThrows) throw std::runtime_error("its end failed");
  }
  void attend() override {
    ++trace_.attended;
    if (fault_ == Fault::kAttendThrows && trace_.steps >= kGoodSteps)
      throw std::runtime_error("its report failed");
  }
  void log_end() override { trace_.logged_end = true; }

  static constexpr int kGoodSteps = 100;
  static constexpr int kGoodTurns = 2;

 private:
  Trace& trace_;
  const Fault fault_;
};

using Fault = SteppingVehicle::Fault;

bool ends_early(Fault fault) {
  return fault != Fault::kNone && fault != Fault::kBlocks && fault != Fault::kStopThrows;
}

// Hosts vehicles with these faults until every one that ends early is destroyed, and those without a fault have stepped and
// were attended after that. Those that block do so until then. Returns the sentence of the end; empty if none failed.
std::string host_all(const std::vector<Fault>& faults, std::vector<Trace>& traces) {
  StopSignal stop;
  std::vector<std::unique_ptr<HostedVehicle>> vehicles;
  for (std::size_t i = 0; i < faults.size(); ++i)
    vehicles.push_back(std::make_unique<SteppingVehicle>("kl" + std::to_string(i + 1), traces[i], faults[i]));
  std::thread observer([&] {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    const auto settled = [&] {
      for (std::size_t i = 0; i < faults.size(); ++i) {
        if (ends_early(faults[i]) && !traces[i].destroyed) return false;
      }
      return true;
    };
    while (!settled() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    std::vector<std::pair<int, int>> before;
    for (const Trace& trace : traces) before.emplace_back(trace.steps, trace.attended);
    const auto go_on = [&] {
      for (std::size_t i = 0; i < faults.size(); ++i) {
        const auto [steps, attended] = before[i];
        if (faults[i] == Fault::kNone && (traces[i].steps < steps + SteppingVehicle::kGoodSteps ||
                                          traces[i].attended < attended + SteppingVehicle::kGoodTurns))
          return false;
      }
      return true;
    };
    while (!go_on() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    EXPECT_TRUE(settled());
    EXPECT_TRUE(go_on());
    for (Trace& trace : traces) trace.released = true;
    stop.request();
  });
  std::string sentence;
  try {
    host(std::move(vehicles), stop, 1ms);
  } catch (const std::runtime_error& error) {
    sentence = error.what();
  }
  observer.join();
  return sentence;
}

TEST(Hosting, EndsAllVehiclesOnAStop) {
  std::vector<Trace> traces(3);
  EXPECT_EQ(host_all({Fault::kNone, Fault::kNone, Fault::kNone}, traces), "");
  for (const Trace& trace : traces) {
    EXPECT_TRUE(trace.logged_end);
    EXPECT_TRUE(trace.destroyed);
    EXPECT_GE(trace.attended, 1);
  }
}

TEST(Hosting, OneThatFailsEndsAloneHoweverItFails) {
  for (const auto& [fault, why] :
       {std::pair{Fault::kRunThrows, "its step failed"}, std::pair{Fault::kAttendThrows, "its report failed"},
        std::pair{Fault::kReported, "its callback failed"}}) {
    std::vector<Trace> traces(3);
    EXPECT_EQ(host_all({Fault::kNone, fault, Fault::kNone}, traces),
              std::string("1 of 3 vehicles failed: kl2: ") + why);
    EXPECT_TRUE(traces[0].logged_end);
    EXPECT_FALSE(traces[1].logged_end);
    EXPECT_TRUE(traces[2].logged_end);
  }
}

// GIVEN a vehicle whose thread does not return WHEN another one fails THEN that one is destroyed at once, and a third one
// goes on.
TEST(Hosting, OneThatBlocksHoldsUpNoOther) {
  std::vector<Trace> traces(3);
  EXPECT_EQ(host_all({Fault::kBlocks, Fault::kRunThrows, Fault::kNone}, traces),
            "1 of 3 vehicles failed: kl2: its step failed");
  EXPECT_TRUE(traces[0].logged_end);
}

TEST(Hosting, SaysHowManyGoOn) {
  const LogText logged;
  std::vector<Trace> traces(3);
  EXPECT_EQ(host_all({Fault::kFailsAtOnce, Fault::kFailsAtOnce, Fault::kStopThrows}, traces),
            "3 of 3 vehicles failed: kl1: it cannot start; kl2: it cannot start; kl3: its end failed");
  EXPECT_EQ(
      logged.lines(),
      "kl1: it cannot start; this vehicle ends, 1 go on\nkl2: it cannot start; this vehicle ends, 1 go on\n");
}

TEST(Hosting, EndsAtOnceWhenAllHaveFailed) {
  std::vector<Trace> traces(1);
  EXPECT_EQ(host_all({Fault::kRunThrows}, traces), "its step failed");
}

}  // namespace swiftlet::runtime::hosting_test

#include "swiftlet/services/runtime/hosting.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::runtime {
namespace {

using namespace std::chrono_literals;

// What the test sees of a vehicle that has been destroyed.
struct Trace {
  std::atomic<int> steps{0};
  std::atomic<int> attended{0};
  std::atomic<bool> logged_end{false};
  std::atomic<bool> destroyed{false};
};

// Steps until the stop, and fails where it is told to.
class SteppingVehicle final : public HostedVehicle {
 public:
  enum class Fault { kNone, kRunThrows, kAttendThrows, kReported, kLags };

  SteppingVehicle(const std::string& name, Trace& trace, Fault fault)
      : HostedVehicle(name), trace_(trace), fault_(fault) {}
  ~SteppingVehicle() override { trace_.destroyed = true; }

  void run(const std::atomic<bool>& stop) override {
    while (!stop) {
      if (++trace_.steps < kGoodSteps) continue;
      if (fault_ == Fault::kRunThrows) throw std::runtime_error("its step failed");
      if (fault_ == Fault::kReported) fail("its callback failed");
      if (fault_ == Fault::kLags) trace_.steps = kGoodSteps;  // makes no progress
      std::this_thread::yield();
    }
  }
  void attend() override {
    ++trace_.attended;
    if (fault_ == Fault::kAttendThrows && trace_.steps >= kGoodSteps)
      throw std::runtime_error("its report failed");
  }
  void log_end() override { trace_.logged_end = true; }

  static constexpr int kGoodSteps = 100;

 private:
  Trace& trace_;
  const Fault fault_;
};

using Fault = SteppingVehicle::Fault;

// Hosts vehicles with these faults until every failing one is destroyed and the others have stepped on after that.
// Returns the sentence of the end; empty if none failed.
std::string host_all(const std::vector<Fault>& faults, std::vector<Trace>& traces) {
  StopSignal stop;
  std::vector<std::unique_ptr<HostedVehicle>> vehicles;
  for (std::size_t i = 0; i < faults.size(); ++i)
    vehicles.push_back(std::make_unique<SteppingVehicle>("kl" + std::to_string(i + 1), traces[i], faults[i]));
  std::thread observer([&] {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    const auto fails = [&](std::size_t i) { return faults[i] != Fault::kNone && faults[i] != Fault::kLags; };
    const auto settled = [&] {
      for (std::size_t i = 0; i < faults.size(); ++i) {
        if (fails(i) && !traces[i].destroyed) return false;
      }
      return true;
    };
    while (!settled() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    std::vector<int> before;
    for (const Trace& trace : traces) before.push_back(trace.steps);
    const auto go_on = [&] {
      for (std::size_t i = 0; i < faults.size(); ++i) {
        if (faults[i] == Fault::kNone && traces[i].steps < before[i] + SteppingVehicle::kGoodSteps)
          return false;
      }
      return true;
    };
    while (!go_on() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    EXPECT_TRUE(settled());
    EXPECT_TRUE(go_on());
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

TEST(Hosting, OneThatMakesNoProgressHoldsUpNoOther) {
  std::vector<Trace> traces(2);
  EXPECT_EQ(host_all({Fault::kLags, Fault::kNone}, traces), "");
  EXPECT_LE(traces[0].steps, SteppingVehicle::kGoodSteps + 1);
}

TEST(Hosting, EndsAtOnceWhenAllHaveFailed) {
  std::vector<Trace> traces(1);
  EXPECT_EQ(host_all({Fault::kRunThrows}, traces), "its step failed");
}

}  // namespace
}  // namespace swiftlet::runtime

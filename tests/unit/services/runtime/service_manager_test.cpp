#include "swiftlet/services/runtime/service_manager.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/descriptor.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::runtime::service_manager_test {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds kLongest{20'000};

// A service manager: the socket that $NOTIFY_SOCKET names. name: a path, or "@..." for a name that is no file.
class ServiceManager {
 public:
  explicit ServiceManager(const std::string& name) : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name.c_str(), name.size());
    if (name[0] == '@') address.sun_path[0] = 0;
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), length), 0);
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~ServiceManager() { ::unsetenv("NOTIFY_SOCKET"); }
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  // The next line that comes within the time; "" if none does.
  std::string next(std::chrono::milliseconds time = kLongest) {
    pollfd waited{socket_.get(), POLLIN, 0};
    if (::poll(&waited, 1, static_cast<int>(time.count())) != 1) return {};
    std::string line(256, '\0');
    line.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::recv(socket_.get(), line.data(), 256, 0))));
    return line;
  }

 private:
  io::Descriptor socket_;
};

// Goes on until it is told to hang.
class HangingVehicle final : public HostedVehicle {
 public:
  HangingVehicle(const std::atomic<bool>& hangs, std::atomic<int>& asked)
      : HostedVehicle("kl1"), hangs_(hangs), asked_(asked) {}
  void run(const std::atomic<bool>&) override {}
  bool goes_on() const override {
    if (hangs_) ++asked_;
    return !hangs_;
  }

 private:
  const std::atomic<bool>& hangs_;
  std::atomic<int>& asked_;
};

TEST(ServiceManagerTest, HearsWhereItsVariableSays) {
  const tests::TemporaryFolder folder;
  for (const std::string& name :
       {(folder.path() / "notify").string(), "@swiftlet-" + folder.path().filename().string()}) {
    ServiceManager manager(name);
    notify_service_manager("READY=1");
    EXPECT_EQ(manager.next(), "READY=1") << name;
  }
}

TEST(ServiceManagerTest, WithoutOneNothingIsSent) {
  notify_service_manager("READY=1");
  ::setenv("NOTIFY_SOCKET", "/nobody/listens", 1);
  notify_service_manager("READY=1");
  ::setenv("NOTIFY_SOCKET", std::string(4096, '/').c_str(), 1);
  notify_service_manager("READY=1");
  ::unsetenv("NOTIFY_SOCKET");
}

TEST(ServiceManagerTest, IsFedAFewTimesASecond) {
  const tests::TemporaryFolder folder;
  ServiceManager manager((folder.path() / "notify").string());
  Watchdog watchdog;
  for (int i = 0; i < 100; ++i) watchdog.feed();
  EXPECT_EQ(manager.next(), "WATCHDOG=1");
  EXPECT_EQ(manager.next(0ms), "");
}

// GIVEN a vehicle that is served WHEN it hangs THEN the watchdog is fed no more, and again when it goes on.
TEST(ServiceManagerTest, IsFedWhileTheVehicleGoesOn) {
  const tests::TemporaryFolder folder;
  ServiceManager manager((folder.path() / "notify").string());
  std::atomic<bool> hangs{false};
  std::atomic<int> asked{0};
  StopSignal stop;
  std::thread observer([&] {
    EXPECT_EQ(manager.next(), "READY=1");
    EXPECT_EQ(manager.next(), "WATCHDOG=1");
    EXPECT_EQ(manager.next(), "WATCHDOG=1");
    hangs = true;
    while (asked == 0) std::this_thread::yield();
    while (manager.next(0ms) == "WATCHDOG=1") continue;  // was under way
    EXPECT_EQ(manager.next(500ms), "");
    hangs = false;
    EXPECT_EQ(manager.next(), "WATCHDOG=1");
    stop.request();
  });
  std::vector<std::unique_ptr<HostedVehicle>> vehicles;
  vehicles.push_back(std::make_unique<HangingVehicle>(hangs, asked));
  host(std::move(vehicles), stop, 1ms);
  observer.join();
  std::string last;
  for (std::string line = manager.next(0ms); !line.empty(); line = manager.next(0ms)) last = line;
  EXPECT_EQ(last, "STOPPING=1");
}

}  // namespace swiftlet::runtime::service_manager_test

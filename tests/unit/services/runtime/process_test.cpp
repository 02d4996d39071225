// Base of the services' main functions: exit codes, stop signals, logging, real-time privileges.
#include "swiftlet/services/runtime/process.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <pthread.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "tests/support/log_text.hpp"

namespace swiftlet::runtime::process_test {

using namespace std::chrono_literals;

int run(std::vector<std::string> words, const std::function<void()>& body) {
  ProcessOptions options;
  options.realtime.priority = 10;
  words.insert(words.begin(), "prog");
  std::vector<char*> arguments;
  arguments.reserve(words.size());
  for (std::string& word : words) arguments.push_back(word.data());
  return run_process(
      {"prog", "Test", ""}, static_cast<int>(arguments.size()), arguments.data(),
      [&](CommandLine app) { add_process_options(app, options); }, body);
}

TEST(RunProcess, ExitCodeDependsOnTheException) {
  bool ran = false;
  EXPECT_EQ(run({}, [&] { ran = true; }), 0);
  EXPECT_TRUE(ran);
  EXPECT_EQ(run({}, [] { throw io::ConfigError("a.yaml", 3, "mass", "is 0, must be above 0"); }), 2);
  EXPECT_EQ(run({}, [] { throw std::invalid_argument("bad"); }), 2);
  EXPECT_EQ(run({}, [] { throw std::runtime_error("broken"); }), 1);
}

TEST(RunProcess, WrongUsageDoesNotRunTheBody) {
  bool ran = false;
  const auto body = [&] { ran = true; };
  EXPECT_EQ(run({"--no-such-option"}, body), 2);
  EXPECT_EQ(run({"--priority", "100"}, body), 2);
  EXPECT_EQ(run({"--log-level", "loud"}, body), 2);
  EXPECT_EQ(run({"--help"}, body), 0);
  EXPECT_FALSE(ran);
}

TEST(RunProcess, PrintsAFaultAsOneLine) {
  testing::internal::CaptureStderr();
  run({}, [] { throw io::ConfigError("a.yaml", 3, "mass", "is 0, must be above 0"); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "prog: a.yaml:3: mass: is 0, must be above 0\n");
}

// Runs body in a child process, which has its own signals and limits.
int in_child(const std::function<int()>& body) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(body());
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// With the default of 8 MiB, all stacks would be resident once memory is locked.
TEST(RunProcess, ThreadStacksAreOneMebibyte) {
  EXPECT_EQ(in_child([] {
              std::size_t bytes = 0;
              run({}, [&bytes] {
                std::thread([&bytes] {
                  pthread_attr_t attributes;
                  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return;
                  pthread_attr_getstacksize(&attributes, &bytes);
                  pthread_attr_destroy(&attributes);
                }).join();
              });
              return static_cast<int>(bytes >> 10) == 1024 ? 0 : 1;
            }),
            0);
}

TEST(StopSignal, SigintAndSigtermRequestAStop) {
  for (const int signal : {SIGINT, SIGTERM}) {
    EXPECT_EQ(in_child([signal] {
                StopSignal stop;
                if (stop.wait_for(1ms)) return 1;
                ::kill(::getpid(), signal);
                stop.wait();
                return stop.requested() ? 0 : 2;
              }),
              0);
  }
}

TEST(StopSignal, AnyThreadMayRequestAStop) {
  EXPECT_EQ(in_child([] {
              StopSignal stop;
              std::thread other([&] { stop.request(); });
              stop.wait();
              other.join();
              return stop.wait_for(0ms) ? 0 : 1;
            }),
            0);
}

TEST(Realtime, RefusalWithoutPrivilegesIsExplained) {
  constexpr int kCannotDropRights = 77;
  const int code = in_child([] {
    rlimit none{0, 0};
    ::setrlimit(RLIMIT_RTPRIO, &none);
    ::setrlimit(RLIMIT_MEMLOCK, &none);
    constexpr unsigned kNobody = 65534;
    if (::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) return kCannotDropRights;
    RealtimeSettings settings;
    settings.priority = 10;
    if (make_this_thread_realtime(settings) != "SCHED_FIFO 10 is not granted (Operation not permitted)")
      return 1;
    if (lock_memory() != "memory is not locked (RLIMIT_MEMLOCK is limited)") return 2;
    return this_thread_is_realtime() ? 3 : 0;
  });
  if (code == kCannotDropRights) GTEST_SKIP() << "cannot drop root privileges";
  EXPECT_EQ(code, 0);
}

TEST(Realtime, RefusalOfAMissingCoreIsExplained) {
  EXPECT_EQ(in_child([] {
              RealtimeSettings settings;
              settings.priority = 10;
              settings.cpu = 1023;
              const std::string refusal = make_this_thread_realtime(settings);
              return refusal.rfind("core 1023 is not granted (Invalid argument)", 0) == 0 ? 0 : 1;
            }),
            0);
}

TEST(Logging, DestructorFlushesTheQueue) {
  const auto path = std::filesystem::temp_directory_path() / ("swiftlet-log-" + std::to_string(::getpid()));
  testing::internal::CaptureStderr();
  {
    const Logging logging("test", {"warning", path.string()});
    log_info("not severe enough");
    for (int i = 0; i < 100; ++i) log_warning("line {}", i);
  }
  EXPECT_NE(testing::internal::GetCapturedStderr().find("line 99\n"), std::string::npos);
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  std::filesystem::remove(path);
  EXPECT_EQ(text.str().find("not severe"), std::string::npos);
  EXPECT_NE(text.str().find("test warning: line 99\n"), std::string::npos);
}

// A wrong line must not end the thread that flies.
TEST(Logging, SaysThatALineCannotBeFormatted) {
  const tests::LogText logged;
  log_info(fmt::runtime("height {:d} m"), "high");
  EXPECT_EQ(logged.lines().rfind("cannot write a log line: ", 0), 0U) << logged.lines();
}

TEST(Logging, NamesAFileThatCannotBeWritten) {
  try {
    const Logging logging("test", {"info", "/proc/no/such/file"});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("cannot write log file /proc/no/such/file"), std::string::npos);
  }
}

}  // namespace swiftlet::runtime::process_test

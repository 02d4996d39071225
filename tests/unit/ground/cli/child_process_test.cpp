#include "swiftlet/io/command_line/child_process.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/ground/flight/process_group.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::child_process_test {

using namespace std::chrono_literals;

class ChildProcessTest : public testing::Test {
 protected:
  io::ProcessSettings shell(const std::string& script) const {
    return {"child", "/bin/sh", {"-c", script}, folder_ / "child.log"};
  }
  // A shell whose traps are set: it has printed `ready`.
  io::ChildProcess ready(const std::string& before, const std::string& after) const {
    io::ChildProcess child(shell(before + "; echo ready; " + after));
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    while (child.last_log_line() != "ready" && std::chrono::steady_clock::now() < deadline)
      std::this_thread::yield();
    return child;
  }

  tests::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

TEST_F(ChildProcessTest, ReportsExitStatusAndLastLogLine) {
  io::ChildProcess child(shell("echo one; echo two >&2; echo; exit 7"));
  const auto end = child.wait(10s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->to_string(), "ended with exit status 7");
  EXPECT_EQ(child.last_log_line(), "two");
}

TEST_F(ChildProcessTest, ReportsTheSignal) {
  io::ChildProcess child = ready(":", "exec sleep 100");
  EXPECT_FALSE(child.poll());
  child.signal(SIGKILL);
  const auto end = child.wait(10s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->to_string(), "was killed by signal 9 (Killed)");
}

TEST_F(ChildProcessTest, StopSendsSigtermFirst) {
  io::ChildProcess child = ready("trap 'exit 0' TERM", "while :; do sleep 0.01; done");
  EXPECT_EQ(child.stop(10s).to_string(), "ended with exit status 0");
}

TEST_F(ChildProcessTest, StopKillsAProcessThatIgnoresSigterm) {
  io::ChildProcess child = ready("trap '' TERM", "while :; do sleep 0.01; done");
  EXPECT_EQ(child.stop(50ms).to_string(), "was killed by signal 9 (Killed)");
}

TEST_F(ChildProcessTest, DestructorEndsTheProcess) {
  pid_t pid = -1;
  {
    const io::ChildProcess child = ready(":", "exec sleep 100");
    pid = child.pid();
    ASSERT_EQ(kill(pid, 0), 0);
  }
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST_F(ChildProcessTest, HasItsOwnProcessGroup) {
  const io::ChildProcess child = ready(":", "exec sleep 100");
  EXPECT_EQ(getpgid(child.pid()), child.pid()) << "must not receive Ctrl-C of the launcher's terminal";
}

TEST_F(ChildProcessTest, RunsInTheGivenFolder) {
  io::ProcessSettings settings = shell("pwd -P");
  settings.working_directory = folder_;
  io::ChildProcess child(settings);
  ASSERT_TRUE(child.wait(10s));
  EXPECT_EQ(child.last_log_line(), std::filesystem::canonical(folder_).string());
}

TEST_F(ChildProcessTest, ReportsAProgramThatCannotBeStarted) {
  try {
    const io::ChildProcess child({"swiftlet-plant", folder_ / "nothing", {}, folder_ / "child.log"});
    FAIL() << "expected std::runtime_error";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "swiftlet-plant: " + (folder_ / "nothing").string() +
                                             " cannot be started: No such file or directory");
  }
}

TEST_F(ChildProcessTest, GroupNamesTheExitedProcess) {
  io::ProcessSettings well = shell("exec sleep 100");
  well.name = "well";
  well.log_file = folder_ / "well.log";
  io::ProcessSettings ill = shell("echo out of luck; kill -SEGV $$");
  ill.name = "ill";
  ProcessGroup processes({well, ill});
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  std::optional<std::string> exited_process;
  while (!exited_process && std::chrono::steady_clock::now() < deadline)
    exited_process = processes.exited_process();
  EXPECT_EQ(exited_process.value_or("none"),
            "ill was killed by signal 11 (Segmentation fault); last log line: out of luck");
}

TEST_F(ChildProcessTest, GroupReportsUncleanExits) {
  io::ProcessSettings fails = shell("exit 3");
  fails.name = "fails";
  ProcessGroup processes({fails});
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (!processes.exited_process() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::yield();
  const auto complaints = processes.stop();
  ASSERT_EQ(complaints.size(), 1U);
  EXPECT_EQ(complaints.front(), "fails ended with exit status 3");
}

}  // namespace swiftlet::ground::child_process_test

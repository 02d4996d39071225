#include "swiftlet/io/command_line/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::io {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{5};
constexpr std::chrono::milliseconds kReapPeriod{100};

[[noreturn]] void fail(const ProcessSettings& settings, const std::string& what, int error) {
  throw std::runtime_error(settings.name + ": " + what + ": " + std::strerror(error));
}

// Runs in the child between fork and exec: async-signal-safe calls only. Writes errno to the pipe on failure;
// a successful exec closes the pipe.
[[noreturn]] void become_program(char* const* arguments, const char* directory, int log, int input,
                                 int failure_pipe, pid_t launcher) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  setpgid(0, 0);
  const bool ready = prctl(PR_SET_PDEATHSIG, SIGTERM) == 0 && dup2(input, STDIN_FILENO) >= 0 &&
                     dup2(log, STDOUT_FILENO) >= 0 && dup2(log, STDERR_FILENO) >= 0 &&
                     (*directory == '\0' || chdir(directory) == 0);
  if (getppid() != launcher) _exit(EXIT_FAILURE);  // the launcher ended before prctl
  if (ready) execv(arguments[0], arguments);
  const int error = errno;
  if (write(failure_pipe, &error, sizeof error) < 0) _exit(EXIT_FAILURE);
  _exit(EXIT_FAILURE);
}

}  // namespace

std::filesystem::path find_program(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder) / name;
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0) return std::filesystem::absolute(candidate);
  }
  return {};
}

std::string ProcessEnd::to_string() const {
  if (!by_signal) return "ended with exit status " + std::to_string(code);
  return "was killed by signal " + std::to_string(code) + " (" + strsignal(code) + ")";
}

ChildProcess::ChildProcess(ProcessSettings settings) : settings_(std::move(settings)) {
  std::vector<std::string> words = {settings_.program.string()};
  words.insert(words.end(), settings_.arguments.begin(), settings_.arguments.end());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const Descriptor log(
      open(settings_.log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644));
  if (!log.is_open())
    fail(settings_, "log file " + settings_.log_file.string() + " cannot be written", errno);
  const Descriptor input(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!input.is_open()) fail(settings_, "/dev/null cannot be opened", errno);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail(settings_, "cannot create a pipe", errno);
  const Descriptor failure(ends[0]);
  Descriptor failure_writer(ends[1]);

  const pid_t launcher = getpid();
  pid_ = fork();
  if (pid_ < 0) fail(settings_, "cannot create a process", errno);
  if (pid_ == 0) {
    become_program(arguments.data(), settings_.working_directory.c_str(), log.get(), input.get(),
                   failure_writer.get(), launcher);
  }
  failure_writer.close();

  int error = 0;
  ssize_t count = 0;
  do {
    count = read(failure.get(), &error, sizeof error);
  } while (count < 0 && errno == EINTR);
  if (count == sizeof error) {
    waitpid(pid_, nullptr, 0);
    fail(settings_, settings_.program.string() + " cannot be started", error);
  }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : settings_(std::move(other.settings_)), pid_(std::exchange(other.pid_, -1)), end_(other.end_) {}

ChildProcess::~ChildProcess() {
  if (pid_ > 0 && !end_) stop(std::chrono::milliseconds::zero());
}

std::optional<ProcessEnd> ChildProcess::poll() {
  int status = 0;
  if (!end_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    end_ = WIFSIGNALED(status) ? ProcessEnd{true, WTERMSIG(status)} : ProcessEnd{false, WEXITSTATUS(status)};
  }
  return end_;
}

std::optional<ProcessEnd> ChildProcess::wait(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!poll() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(kPollPeriod);
  return end_;
}

void ChildProcess::signal(int number) {
  if (!poll()) kill(pid_, number);
}

ProcessEnd ChildProcess::stop(std::chrono::milliseconds grace) {
  if (grace.count() > 0) signal(SIGTERM);
  if (!wait(grace)) signal(SIGKILL);
  while (!wait(kReapPeriod)) {
  }
  return *end_;
}

std::string ChildProcess::last_log_line() const {
  std::ifstream log(settings_.log_file);
  std::string last;
  for (std::string line; std::getline(log, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace swiftlet::io

#include "tests/support/program.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// State and parent of a process, from /proc/PID/stat; state 0 if it is gone.
struct ProcessStat {
  char state = 0;
  pid_t parent = -1;
};
ProcessStat stat_of(pid_t pid) {
  const std::string text = contents("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name_end = text.rfind(')');  // the name before it may contain anything
  ProcessStat stat;
  if (name_end != std::string::npos)
    std::istringstream(text.substr(name_end + 1)) >> stat.state >> stat.parent;
  return stat;
}

}  // namespace

// A file of /proc may fail halfway when its process ends. An iterator over the stream buffer would throw then.
std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Program::Program(const std::string& name, std::vector<std::string> arguments, const fs::path& folder) {
  static std::atomic<int> count{0};
  const std::string stem = name + "-" + std::to_string(++count);
  output_file_ = folder / (stem + ".out");
  error_file_ = folder / (stem + ".err");
  arguments.insert(arguments.begin(), program_file(name));
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);

  const int output = open(output_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const int errors = open(error_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);
  setenv("SWIFTLET_CONFIG_DIR", in_source("config").c_str(), 1);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(errors, STDERR_FILENO);
    execv(words[0], words.data());
    _exit(127);
  }
  close(input);
  close(output);
  close(errors);
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
}

Program::~Program() {
  if (exit_code()) return;
  kill(pid_, SIGTERM);
  if (wait(5s) != -1) return;
  kill(pid_, SIGKILL);
  wait(5s);
}

void Program::signal(int number) const {
  if (!exit_code_) kill(pid_, number);
}

std::optional<int> Program::exit_code() {
  int status = 0;
  if (!exit_code_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }
  return exit_code_;
}

int Program::wait(std::chrono::milliseconds timeout) {
  eventually([this] { return exit_code().has_value(); }, timeout);
  return exit_code().value_or(-1);
}

std::string Program::output() const { return contents(output_file_); }
std::string Program::errors() const { return contents(error_file_); }

ProgramResult run_program(const std::string& name, std::vector<std::string> arguments, const fs::path& folder,
                          std::chrono::milliseconds timeout) {
  Program program(name, std::move(arguments), folder);
  const int exit_code = program.wait(timeout);
  return {exit_code, program.output(), program.errors()};
}

std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const pid_t pid = std::stoi(name);
    if (stat_of(pid).parent == parent) children.push_back(pid);
  }
  return children;
}

pid_t child_of(pid_t parent, const std::string& program) {
  for (const pid_t pid : children_of(parent)) {
    std::error_code gone;
    const fs::path file = fs::read_symlink("/proc/" + std::to_string(pid) + "/exe", gone);
    if (file.filename() == program) return pid;
  }
  return -1;
}

std::string command_line_of(pid_t pid) { return contents("/proc/" + std::to_string(pid) + "/cmdline"); }

bool is_running(pid_t pid) {
  const char state = stat_of(pid).state;
  return state != 0 && state != 'Z' && state != 'X';
}

}  // namespace swiftlet::tests

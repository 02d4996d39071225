// Runs one of the project's programs from a test.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace swiftlet::tests {

class Program {
 public:
  // Starts `name`, a program in the build's bin folder or an absolute path. Its output goes to files in
  // `folder`. The destructor ends it.
  Program(const std::string& name, std::vector<std::string> arguments, const std::filesystem::path& folder);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;

  // Exit status; 128 + signal if killed; nullopt while it runs.
  std::optional<int> exit_code();
  // Waits for the exit code; -1 after the timeout.
  int wait(std::chrono::milliseconds timeout);

  std::string output() const;  // standard output so far
  std::string errors() const;  // standard error so far

 private:
  std::filesystem::path output_file_, error_file_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

// Exit code and output of a program.
struct ProgramResult {
  int exit_code = -1;
  std::string output;
  std::string errors;
};
ProgramResult run_program(const std::string& name, std::vector<std::string> arguments,
                          const std::filesystem::path& folder,
                          std::chrono::milliseconds timeout = std::chrono::seconds(30));

std::string contents(const std::filesystem::path& file);  // as much as can be read
bool contains(const std::string& text, const std::string& part);

// Facts about processes from /proc. A process may end at any moment; the result is empty then.

// The child of a process that runs this program; -1 if there is none.
pid_t child_of(pid_t parent, const std::string& program);
std::vector<pid_t> children_of(pid_t parent);
std::string command_line_of(pid_t pid);  // arguments, each terminated by NUL
bool is_running(pid_t pid);              // false for a zombie

}  // namespace swiftlet::tests

// One of the project's programs, run by a test as a user would run it.
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
  // `name` is that of a program in the build's bin folder, or a path from the root. Output goes to files in
  // `folder`. Ends with the test.
  Program(const std::string& name, std::vector<std::string> arguments, const std::filesystem::path& folder);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;

  // Exit status, 128 + signal for one that was killed, nothing while it runs.
  std::optional<int> exit_code();
  // Waits for the end; -1 if it does not come in time.
  int wait(std::chrono::milliseconds timeout);

  std::string output() const;  // standard output so far
  std::string errors() const;  // standard error so far

 private:
  std::filesystem::path output_file_, error_file_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

// What a finished run of a program gave.
struct Ending {
  int exit_code = -1;
  std::string output;
  std::string errors;
};
Ending run_program(const std::string& name, std::vector<std::string> arguments,
                   const std::filesystem::path& folder,
                   std::chrono::milliseconds timeout = std::chrono::seconds(30));

// What the kernel tells of processes, which may end at any moment: nothing is told then.

// The child of a process whose program has this name; -1 if there is none.
pid_t child_of(pid_t parent, const std::string& program);
std::vector<pid_t> children_of(pid_t parent);
std::string command_line_of(pid_t pid);  // words, each ended by a NUL
bool is_running(pid_t pid);              // false for one that has ended and was not reaped

// The files in /dev/shm that a process has open or mapped.
std::vector<std::string> shared_memory_of(pid_t pid);

}  // namespace swiftlet::tests

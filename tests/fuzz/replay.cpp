// Feeds a fuzzer's function with the files of some folders and with mutations of them, the same on every run.
//   PROGRAM LONGEST MUTATIONS [FOLDER...]
// A failure ends the process; the current input remains in a file that is printed at the start.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) int LLVMFuzzerInitialize(int* argc, char*** argv);

namespace {

namespace fs = std::filesystem;

constexpr unsigned kLongest_s = 20;  // timeout of one input, with sanitizers

// Words that are difficult for parsers.
const std::vector<std::string> kWords = {"nan", ".inf", "-",  "1e309", "0",   "4294967296", "[]", "{}",
                                         "\n",  ",",    ": ", "\"",    "\\u", "\xff",       "~",  "    "};

class Mutations {
 public:
  Mutations(const std::vector<std::string>& inputs, std::size_t longest)
      : inputs_(inputs), longest_(longest) {}

  std::string next() {
    std::string text = inputs_[below(inputs_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(text);
    return text.substr(0, longest_);
  }

 private:
  void change(std::string& text) {
    const std::size_t at = below(text.size() + 1);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        return;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        return;
      case 2:
        text.erase(at, 1 + below(16));
        return;
      case 3:
        text.insert(at, kWords[below(kWords.size())]);
        return;
      case 4:
        text.insert(at, part_of(text));
        return;
      default:
        text.insert(at, part_of(inputs_[below(inputs_.size())]));
    }
  }
  std::string part_of(const std::string& text) { return text.substr(below(text.size() + 1), 1 + below(64)); }
  std::size_t below(std::size_t end) { return random_() % end; }

  const std::vector<std::string>& inputs_;
  std::size_t longest_;
  std::mt19937_64 random_{1};
};

std::vector<std::string> files_in(const std::vector<std::string>& folders, std::size_t longest) {
  std::vector<fs::path> paths;
  for (const std::string& folder : folders) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file()) paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> inputs = {""};
  for (const fs::path& path : paths) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    inputs.push_back(text.str().substr(0, longest));
  }
  return inputs;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s LONGEST MUTATIONS [FOLDER...]\n", argv[0]);
    return 2;
  }
  const std::size_t longest = std::stoul(argv[1]);
  const std::size_t mutations = std::stoul(argv[2]);
  const std::vector<std::string> inputs = files_in({argv + 3, argv + argc}, longest);
  const std::string name = fs::path(argv[0]).filename();
  if (LLVMFuzzerInitialize != nullptr) LLVMFuzzerInitialize(&argc, &argv);

  const fs::path input_file = fs::absolute(name + ".input");
  std::printf("the current input is in %s\n", input_file.c_str());
  std::fflush(stdout);
  const int file = open(input_file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC,
                        0600);  // opened once, since this costs more than writing
  const auto feed = [&](const std::string& input) {
    if (pwrite(file, input.data(), input.size(), 0) < 0 ||
        ftruncate(file, static_cast<off_t>(input.size())) != 0)
      std::perror(input_file.c_str());
    alarm(kLongest_s);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  };
  for (const std::string& input : inputs) feed(input);
  Mutations mutated(inputs, longest);
  for (std::size_t i = 0; i < mutations; ++i) feed(mutated.next());
  alarm(0);
  fs::remove(input_file);
  std::printf("%zu files and %zu mutations of them: no fault\n", inputs.size() - 1, mutations);
  return 0;
}

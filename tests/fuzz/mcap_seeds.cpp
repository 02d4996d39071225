// Writes inputs for mcap_fuzzer.cpp:
//   mcap_seeds FOLDER
#include <filesystem>
#include <fstream>

#include "tests/unit/record/mcap/recorded_file.hpp"

using namespace swiftlet;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  tests::write_file(folder / "zstd", 9, mcap::Compression::kZstd);
  tests::write_file(folder / "lz4", 9, mcap::Compression::kLz4);
  tests::write_file(folder / "plain", 9, mcap::Compression::kNone);
  const std::string whole = tests::file_content(folder / "plain");
  std::ofstream(folder / "cut", std::ios::binary) << whole.substr(0, whole.size() / 2);
  return 0;
}

#include "swiftlet/ground/cli/analysis/batch_output.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/batch/batch_page.hpp"
#include "swiftlet/ground/batch/batch_plot.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::uintmax_t kPictureBytes = 1'500'000;  // with the libraries of the page
constexpr std::uintmax_t kRunBytes = 1'500;  // a row of batch.csv and its part of batch.gp and batch.html

// Returns a sentence if a file cannot be written whole.
std::string write_files(const std::filesystem::path& folder, const BatchReport& report,
                        io::ProgressLine& progress) {
  std::string fault;
  try {
    write_batch_csv(folder / "batch.csv", report);
    io::write_atomically(folder / "batch.html", batch_page(report));
  } catch (const std::exception& error) {
    fault = error.what();
  }
  try {
    const std::string no_picture = draw_batch(folder, report);
    if (!no_picture.empty()) progress.say(no_picture);
  } catch (const std::exception& error) {
    if (fault.empty()) fault = error.what();
  }
  return fault;
}

}  // namespace

std::uintmax_t batch_bytes(std::size_t runs) { return kPictureBytes + kRunBytes * runs; }

void print_batch(const BatchReport& report, bool json, io::ProgressLine& progress) {
  progress.close();
  std::printf("%s", json ? (io::json_text(to_json(report)) + "\n").c_str() : to_text(report).c_str());
  if (report.interrupted())
    progress.say(fmt::format("swiftlet: batch cancelled after {} of {} runs", report.batch.runs.size(),
                             report.batch.requested));
}

int finish_batch(const BatchReport& report, bool json, io::ProgressLine& progress) {
  const std::string record_fault = write_files(report.folder, report, progress);
  print_batch(report, json, progress);
  if (!record_fault.empty())
    progress.say("swiftlet: the record " + report.folder + " is incomplete: " + record_fault);
  return report.completed() && record_fault.empty() ? io::kDone : io::kFailed;
}

}  // namespace swiftlet::ground

// The files and the text in which `swiftlet sim batch` and `swiftlet sim merge` give the result of a batch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "swiftlet/ground/batch/batch_report.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"

namespace swiftlet::ground {

// Size of the files of a batch, somewhat above that of real ones.
std::uintmax_t batch_bytes(std::size_t runs);

// Closes the progress line, and prints the table or, with `json`, one JSON object; says if the batch was cancelled.
void print_batch(const BatchReport& report, bool json, io::ProgressLine& progress);

// Writes batch.csv and batch.png into report.folder, and prints the report. Returns the exit code.
int finish_batch(const BatchReport& report, bool json, io::ProgressLine& progress);

}  // namespace swiftlet::ground

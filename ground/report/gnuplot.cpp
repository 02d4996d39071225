#include "swiftlet/ground/report/gnuplot.hpp"

#include <chrono>

#include "swiftlet/services/runtime/child_process.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::seconds kPlotTimeout{30};

}  // namespace

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

std::string run_gnuplot(const std::filesystem::path& folder, const std::string& name) {
  const std::string script = name + ".gp";
  const std::filesystem::path gnuplot = find_program("gnuplot");
  if (gnuplot.empty())
    return "no picture was drawn: gnuplot is not installed (" + script + " draws it from " + name + ".csv)";
  const std::filesystem::path log = folder / "gnuplot.log";
  ChildProcess plot({"gnuplot", gnuplot, {script}, log, folder});
  const auto end = plot.wait(kPlotTimeout);
  if (!end) return "no picture was drawn: gnuplot took longer than 30 s";
  if (end->by_signal || end->code != 0) {
    return "no picture was drawn: gnuplot " + end->to_string() + ": " + plot.last_log_line();
  }
  std::filesystem::remove(log);
  return {};
}

}  // namespace swiftlet::ground

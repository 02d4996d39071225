#include "swiftlet/ground/flight/record_folder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include <fmt/core.h>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr const char* kClaim = "record.txt";
constexpr std::array kRecordFiles = {
    "record.txt", "report.json", "flight.csv",   "flight.gp",    "flight.mcap",    "flight.html",
    "flight.png", "trace.csv",   "sensors.csv",  "batch.csv",    "batch.html",     "batch.gp",
    "batch.png",  "shard.json",  "control.yaml", "vehicle.yaml", "simulation.yaml"};

bool is_record_file(const fs::path& file) {
  const std::string name = file.extension() == ".part" ? file.stem() : file.filename();
  const bool named = std::find(kRecordFiles.begin(), kRecordFiles.end(), name) != kRecordFiles.end();
  return named || file.stem() == "mission" || (file.extension() == ".log" && name.rfind("swiftlet-", 0) == 0);
}

// The first entry that no flight writes; empty if there is none. Records of several vehicles have a folder
// for each.
fs::path foreign_entry(const fs::path& folder, bool may_hold_vehicles = true) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_symlink()) return entry.path();
    if (entry.is_directory()) {
      if (!may_hold_vehicles) return entry.path();
      if (fs::path inside = foreign_entry(entry.path(), false); !inside.empty()) return inside;
    } else if (!is_record_file(entry.path())) {
      return entry.path();
    }
  }
  return {};
}

bool holds_record(const fs::path& folder) {
  return fs::exists(folder / kClaim) || fs::exists(folder / "report.json");
}

std::string who_claims() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 32> time{};
  std::strftime(time.data(), time.size(), "%Y-%m-%d %H:%M:%S", &local);
  return fmt::format("process {} on {}, {}", getpid(), host.data(), time.data());
}

// " (process 12 on lab, 2026-11-21 09:39:09)" if the folder says so.
std::string owner_of(const fs::path& folder) {
  std::ifstream in(folder / kClaim);
  std::string owner;
  std::getline(in, owner);
  return owner.empty() ? "" : " (" + owner + ")";
}

bool is_inside(const fs::path& folder, const fs::path& file) {
  const fs::path relative = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
  return !relative.empty() && *relative.begin() != "..";
}

std::string named(const std::string& option, const fs::path& folder) {
  return option + " " + folder.string() + ": ";
}

[[noreturn]] void refuse(const std::string& option, const fs::path& folder) {
  throw io::InputError(named(option, folder) +
                       (foreign_entry(folder).empty()
                            ? "the folder holds another record" + owner_of(folder) +
                                  "; choose another folder, or add --replace to delete that record first"
                            : "the folder is not empty; choose a new or an empty one"));
}

// A lock of record.txt that ends with this object; a flight holds it until it ends.
class OldClaim {
 public:
  explicit OldClaim(const fs::path& folder)
      : descriptor_(open((folder / kClaim).c_str(), O_RDONLY | O_CLOEXEC)),
        free_(!descriptor_.is_open() || flock(descriptor_.get(), LOCK_EX | LOCK_NB) == 0) {}

  bool is_free() const { return free_; }

 private:
  io::Descriptor descriptor_;
  bool free_;
};

void remove_record(const fs::path& folder, const std::string& option, const std::vector<fs::path>& inputs) {
  if (fs::is_empty(folder)) return;
  if (!holds_record(folder))
    throw io::InputError(named(option, folder) +
                         "--replace deletes records only, and the folder holds none (" +
                         "no record.txt or report.json); choose another folder");
  for (const fs::path& input : inputs) {
    if (is_inside(folder, input))
      throw io::InputError(named(option, folder) + "--replace would delete " + input.string() +
                           ", which this flight reads; choose another folder");
  }
  if (const fs::path foreign = foreign_entry(folder); !foreign.empty()) {
    throw io::InputError(named(option, folder) + "--replace deletes records only, and no flight writes " +
                         foreign.lexically_relative(folder).string() + "; choose another folder");
  }
  const OldClaim old(folder);
  if (!old.is_free())
    throw io::InputError(named(option, folder) + "a flight is writing it" + owner_of(folder) +
                         "; choose another folder");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) fs::remove_all(entry.path());
}

// True if another process that replaces the record has deleted the file.
bool is_deleted(int descriptor) {
  struct stat file {};
  return fstat(descriptor, &file) != 0 || file.st_nlink == 0;
}

fs::path nearest_existing(const fs::path& folder) {
  std::error_code ignored;
  fs::path at = fs::absolute(folder).lexically_normal();
  while (at.has_relative_path() && !fs::exists(at, ignored)) at = at.parent_path();
  return at;
}

}  // namespace

RecordFolder::RecordFolder(const fs::path& wanted, ExistingRecord existing, const std::string& option,
                           const std::vector<fs::path>& inputs)
    : option_(option) {
  try {
    if (existing == ExistingRecord::kReplaced && fs::is_directory(wanted))
      remove_record(wanted, option, inputs);
    bool taken = take(wanted, option);
    for (int i = 2; !taken && existing == ExistingRecord::kNumbered; ++i)
      taken = take(wanted.string() + "-" + std::to_string(i), option);
    if (!taken) refuse(option, wanted);
  } catch (const fs::filesystem_error& fault) {
    throw io::InputError(named(option, wanted) + "the folder cannot be used: " + fault.code().message());
  }
}

RecordFolder::~RecordFolder() {
  if (claim_ < 0) return;
  std::error_code fault;
  const auto entries = std::distance(fs::directory_iterator(path_, fault), fs::directory_iterator());
  if (entries == 1) fs::remove(path_ / kClaim, fault);
  if (entries == 1 && made_) fs::remove(path_, fault);
  close(claim_);
}

fs::path RecordFolder::folder_of(const std::string& vehicle) const {
  std::error_code fault;
  fs::create_directory(path_ / vehicle, fault);
  if (fault)
    throw io::InputError(named(option_, path_ / vehicle) +
                         "the folder cannot be created: " + fault.message());
  return path_ / vehicle;
}

// Returns false if the folder holds anything already.
bool RecordFolder::take(const fs::path& folder, const std::string& option) {
  std::error_code fault;
  made_ = fs::create_directories(folder, fault);
  if (fault) throw io::InputError(named(option, folder) + "the folder cannot be created: " + fault.message());
  if (!fs::is_empty(folder)) return false;
  claim_ = open((folder / kClaim).c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0644);
  if (claim_ < 0 && errno == EEXIST) return false;
  const std::string owner = who_claims() + "\n";
  const bool written = claim_ >= 0 && flock(claim_, LOCK_EX | LOCK_NB) == 0 && !is_deleted(claim_) &&
                       write(claim_, owner.data(), owner.size()) == static_cast<ssize_t>(owner.size());
  if (!written) {
    const std::string reason = std::generic_category().message(errno);
    if (claim_ >= 0) {
      fs::remove(folder / kClaim, fault);
      close(claim_);
    }
    throw io::InputError(named(option, folder) + "the folder cannot be written: " + reason);
  }
  path_ = folder;
  return true;
}

void require_space(const fs::path& folder, std::uintmax_t needed_bytes, const std::string& option) {
  std::error_code unknown;
  const fs::space_info space = fs::space(nearest_existing(folder), unknown);
  if (unknown) return;
  const std::string fault = space_fault(needed_bytes, space.available);
  if (!fault.empty()) throw io::InputError(named(option, folder) + fault);
}

std::string space_fault(std::uintmax_t needed_bytes, std::uintmax_t free_bytes) {
  if (free_bytes >= needed_bytes) return {};
  constexpr double kMegabyte = 1e6;
  return fmt::format(
      "the record needs about {:.1f} MB, {:.1f} MB are free; choose a folder on another disk, or make room",
      static_cast<double>(needed_bytes) / kMegabyte, static_cast<double>(free_bytes) / kMegabyte);
}

}  // namespace swiftlet::ground

// The folder of a flight record. One flight makes it and no other writes into it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet::ground {

enum class ExistingRecord {
  kRefused,   // the folder must be new or empty
  kReplaced,  // the whole record in it is deleted first
  kNumbered,  // another folder is made: NAME-2, NAME-3, ...
};

class RecordFolder {
 public:
  // Makes the folder and claims it with the file record.txt, which names the process. Of several processes
  // that claim one folder at the same time, one gets it. option: the command-line option that names the
  // folder. inputs: files that the flight reads. Throws InputError if the folder cannot be made, holds anything
  // and may not be replaced, holds files that no flight writes or an input, or belongs to a flight in progress.
  RecordFolder(const std::filesystem::path& wanted, ExistingRecord existing,
               const std::string& option = "--record", const std::vector<std::filesystem::path>& inputs = {});
  ~RecordFolder();  // leaves no trace if nothing was written into the folder
  RecordFolder(const RecordFolder&) = delete;
  RecordFolder& operator=(const RecordFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Makes the folder of one of several vehicles. Throws InputError.
  std::filesystem::path folder_of(const std::string& vehicle) const;

 private:
  bool take(const std::filesystem::path& folder, const std::string& option);

  std::string option_;
  std::filesystem::path path_;
  bool made_ = false;  // did not exist before
  int claim_ = -1;     // descriptor of record.txt, locked while this object lives
};

// Throws InputError if the file system of the folder, which need not exist, has fewer free bytes than needed.
void require_space(const std::filesystem::path& folder, std::uintmax_t needed_bytes,
                   const std::string& option = "--record");

// A sentence if fewer bytes are free than needed; empty otherwise.
std::string space_fault(std::uintmax_t needed_bytes, std::uintmax_t free_bytes);

}  // namespace swiftlet::ground

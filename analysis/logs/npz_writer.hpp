// Writes NumPy's .npz: a ZIP archive, without compression, of .npy arrays. numpy.load() reads it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet::analysis {

class NpzWriter {
 public:
  // An array in row-major order. Shape (rows) if columns is 1, else (rows, columns). Throws std::runtime_error if the
  // archive would be larger than 4 GB, the limit of its format.
  void add(const std::string& name, const std::vector<double>& values, std::size_t columns);
  void add(const std::string& name, const std::vector<std::int64_t>& values, std::size_t columns);
  void add(const std::string& name, const std::vector<std::uint64_t>& values, std::size_t columns);
  void add(const std::string& name, const std::vector<std::string>& values);  // of bytes: dtype S

  // Writes the file when it is complete. Throws std::runtime_error.
  void write(const std::filesystem::path& file) const;

 private:
  struct Entry {
    std::string name;
    std::uint32_t crc = 0;
    std::uint32_t size = 0;
    std::uint32_t offset = 0;
  };

  void add_array(const std::string& name, const std::string& type, std::size_t count, std::size_t columns,
                 const void* data, std::size_t bytes);

  std::string archive_;
  std::vector<Entry> entries_;
};

}  // namespace swiftlet::analysis

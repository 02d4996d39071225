// A simulated flight to the last bit: the truth at each IMU sample and the command that answered it, as CSV.
// Two flights are the same if and only if their traces are the same bytes.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::runtime {

// From the first sample to the one whose command stops the rotors again. Columns: t_ns, position, velocity,
// attitude, body rates (NED, FRD, SI), rotor speeds, supply voltage, on_ground, then of the command: its
// mocap frame, running, throttles; each number in the shortest form that reads back as the same.
class FlightTrace {
 public:
  // Throws std::runtime_error if the file cannot be written, as do the others.
  FlightTrace(const std::string& path, int rotor_count);

  void add(const plant::TruthSample& truth, const plant::ActuatorCommand& command);
  void close();

  bool complete() const { return complete_; }  // the rotors ran and have stopped; nothing is added any more

 private:
  void demand(bool written) const;

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::string row_;
  bool running_ = false;
  bool complete_ = false;
};

}  // namespace swiftlet::runtime

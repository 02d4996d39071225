// Bit-exact trace of a simulated flight as CSV: the ground truth at each IMU sample and the command computed
// from that sample. Two flights are identical if and only if their traces are identical byte by byte.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::record {

// The trace runs from the first sample to the one whose command stops the rotors. Columns: t_ns, position,
// velocity, attitude, body rates (NED, FRD, SI), rotor speeds, supply voltage, on_ground, and of the command:
// sequence of its mocap frame, running, throttles. Each number has the shortest form that parses to the same
// value.
class FlightTrace {
 public:
  // Throws std::runtime_error if the file cannot be written.
  FlightTrace(const std::string& path, int rotor_count);

  // A flight goes on without its trace: a row that cannot be written ends the trace, and close() reports it.
  void add(const plant::TruthSample& truth, const plant::ActuatorCommand& command);
  // Throws std::runtime_error if not all rows could be written.
  void close();

  bool complete() const { return complete_; }  // the rotors ran and have stopped; add() has no further effect

 private:
  [[noreturn]] void fail(int error) const;

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::string row_;
  bool running_ = false;
  bool complete_ = false;
  int error_ = 0;  // errno of the first row that could not be written
};

}  // namespace swiftlet::record

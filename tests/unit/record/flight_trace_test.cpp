#include "swiftlet/record/flight_trace.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace swiftlet::record::flight_trace_test {

plant::TruthSample truth(std::int64_t stamp_ns) {
  plant::TruthSample sample;
  sample.stamp_ns = stamp_ns;
  sample.position_ned = {1.0 / 3.0, -0.1, 1e-300};
  sample.rotor_count = 4;
  sample.rotor_speeds = {100.1, 200.2, 300.3, 400.4};
  sample.supply_voltage_v = 3.7;
  return sample;
}

plant::ActuatorCommand command(plant::RotorState state) {
  plant::ActuatorCommand answer;
  answer.mocap_sequence = 12;
  answer.rotor_state = state;
  answer.rotor_count = 4;
  answer.throttle = {0.1, 0.2, 0.3, 0.7};
  return answer;
}

TEST(FlightTrace, WritesNumbersExactly) {
  const tests::TemporaryFolder folder;
  const std::string file = folder.path() / "trace.csv";
  FlightTrace trace(file, 4);
  trace.add(truth(2'000'000), command(plant::RotorState::kRunning));
  trace.close();

  std::ifstream in(file);
  std::string columns;
  std::getline(in, columns);
  EXPECT_EQ(columns,
            "t_ns,px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1,om2,om3,om4,v_s,on_ground,mocap_frame,running,"
            "delta1,delta2,delta3,delta4");
  std::string row;
  std::getline(in, row);
  EXPECT_EQ(
      row,
      "2000000,0.3333333333333333,-0.1,1e-300,0,0,0,1,0,0,0,0,0,0,100.1,200.2,300.3,400.4,3.7,0,12,1,0.1,"
      "0.2,0.3,0.7");
  EXPECT_EQ(std::stod(row.substr(row.find(',') + 1)), 1.0 / 3.0);
}

TEST(FlightTrace, EndsWhenTheRotorsStop) {
  const tests::TemporaryFolder folder;
  const std::string file = folder.path() / "trace.csv";
  FlightTrace trace(file, 4);
  for (const auto state :
       {plant::RotorState::kOff, plant::RotorState::kRunning, plant::RotorState::kRunning}) {
    trace.add(truth(0), command(state));
    EXPECT_FALSE(trace.complete());
  }
  trace.add(truth(0), command(plant::RotorState::kOff));
  EXPECT_TRUE(trace.complete());
  trace.add(truth(0), command(plant::RotorState::kOff));
  trace.add(truth(0), command(plant::RotorState::kRunning));
  trace.close();
  std::ifstream in(file);
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(in), {}, '\n'), 5) << "a header and four rows";
}

TEST(FlightTrace, ReportsAFileThatCannotBeWritten) {
  try {
    FlightTrace trace("/nonexistent/trace.csv", 4);
    FAIL() << "no error for a path that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/nonexistent/trace.csv: cannot be written: No such file or directory");
  }
  FlightTrace full("/dev/full", 4);
  for (int i = 0; i < 1000; ++i)  // more than a buffer
    EXPECT_NO_THROW(full.add(truth(0), command(plant::RotorState::kOff))) << "the flight goes on";
  EXPECT_THROW(full.close(), std::runtime_error);
}

}  // namespace swiftlet::record::flight_trace_test

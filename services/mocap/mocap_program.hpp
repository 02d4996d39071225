// swiftlet-mocap: publishes the poses of vehicles, from a motion capture or from a simulation of one.
#pragma once

namespace swiftlet::services {

// The whole program, apart from main.cpp so that the compiler reads the headers once for it and its parts. Returns the exit code.
int run_mocap(int argc, char** argv);

}  // namespace swiftlet::services

// swiftlet-plant: the simulated vehicles.
#pragma once

namespace swiftlet::services {

// The whole program, apart from main.cpp so that the compiler reads the headers once for it and its parts. Returns the exit code.
int run_plant(int argc, char** argv);

}  // namespace swiftlet::services

#include "swiftlet/services/mocap/mocap_program.hpp"

int main(int argc, char** argv) { return swiftlet::services::run_mocap(argc, argv); }

#include "swiftlet/services/control/control_program.hpp"

int main(int argc, char** argv) { return swiftlet::services::run_control(argc, argv); }

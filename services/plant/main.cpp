#include "swiftlet/services/plant/plant_program.hpp"

int main(int argc, char** argv) { return swiftlet::services::run_plant(argc, argv); }

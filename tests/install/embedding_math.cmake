# Builds the slowest part of the project configured by embedding.cmake.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/embedding --target swiftlet_math)

# Builds, of the project that embedding.cmake has configured, what takes longest.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/embedding --target swiftlet_math)

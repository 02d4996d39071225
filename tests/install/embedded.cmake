# Builds and runs the program of the project that embedding.cmake has configured: only what it links is built.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(embedding ${WORK_DIR}/embedding)
run(${CMAKE_COMMAND} --build ${embedding} --target hover)
run(${embedding}/hover)

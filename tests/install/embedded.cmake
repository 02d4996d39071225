# Builds and runs the program of the project configured by embedding.cmake; builds only what it links.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(embedding ${WORK_DIR}/embedding)
run(${CMAKE_COMMAND} --build ${embedding} --target hover)
run(${embedding}/hover)

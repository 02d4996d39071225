# Links each component of the installed package alone, in the project configured by consumer.cmake.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer --target links)

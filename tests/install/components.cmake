# Links each component of the installed package alone, in the project that consumer.cmake has configured.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer --target links)

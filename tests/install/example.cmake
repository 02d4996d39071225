# Builds, in the project that consumer.cmake has configured, the other example, and runs it without a vehicle.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(consumer ${WORK_DIR}/consumer)
run(${CMAKE_COMMAND} --build ${consumer} --target fly_square)
execute_process(COMMAND ${consumer}/fly_square nobody 229 RESULT_VARIABLE alone ERROR_VARIABLE said)
if(NOT alone EQUAL 1 OR NOT said MATCHES "no control service for vehicle nobody in domain 229")
  message(FATAL_ERROR "the example said: ${said}")
endif()

# Builds, in the project that consumer.cmake has configured, a program that flies vehicles, and runs it without one.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(consumer ${WORK_DIR}/consumer)
run(${CMAKE_COMMAND} --build ${consumer} --target fly_mission)

# Libraries that the client links, directly and indirectly.
execute_process(COMMAND readelf -d ${consumer}/fly_mission OUTPUT_VARIABLE needed COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ldd ${consumer}/fly_mission OUTPUT_VARIABLE loaded COMMAND_ERROR_IS_FATAL ANY)
if(NOT needed MATCHES "libfast(rtps|dds)")
  message(FATAL_ERROR "readelf did not say what is linked: ${needed}")
endif()
foreach(heavy ceres glog CLI11 ncurses tinfo gnuplot)
  if("${needed}${loaded}" MATCHES "${heavy}")
    message(FATAL_ERROR "a program that stands on swiftlet::ground_client links ${heavy}: ${needed}${loaded}")
  endif()
endforeach()
if(needed MATCHES "libz\\.")  # some builds of OpenSSL load it
  message(FATAL_ERROR "a program that stands on swiftlet::ground_client links libz: ${needed}")
endif()
file(STRINGS ${prefix}/share/swiftlet/examples/fly_mission.cpp lines)
list(LENGTH lines count)
if(count GREATER 30)
  message(FATAL_ERROR "fly_mission.cpp has ${count} lines")
endif()
execute_process(COMMAND ${consumer}/fly_mission ${prefix}/share/swiftlet/config/missions/square.yaml nobody 229 --localhost-only
  RESULT_VARIABLE alone OUTPUT_VARIABLE said)
if(NOT alone EQUAL 1 OR NOT said MATCHES "arm: no control service for vehicle nobody in domain 229")
  message(FATAL_ERROR "the example said: ${said}")
endif()

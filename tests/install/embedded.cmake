# Builds and runs a project with this one as a subdirectory, without a build type. Only what it links is built. The warning flags and
# tests of this project must not apply there.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(embedding ${WORK_DIR}/embedded)
file(REMOVE_RECURSE ${embedding})
run(${CMAKE_COMMAND} -S ${TEST_DIR}/embedded -B ${embedding} ${configuration} -DCMAKE_BUILD_TYPE= -DSWIFTLET_DIR=${SOURCE_DIR}
  -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
file(STRINGS ${embedding}/compile_commands.json commands REGEX "\"command\"")
foreach(command IN LISTS commands)
  if(command MATCHES "-Werror|gtest|cmake_pch")
    message(FATAL_ERROR "compile command has flags that only this project's own build may use: ${command}")
  endif()
endforeach()
run(${CMAKE_COMMAND} --build ${embedding} --target attitude)
run(${embedding}/attitude)

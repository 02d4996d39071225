# Run by CTest: see CMakeLists.txt beside it for the variables.

set(prefix ${WORK_DIR}/prefix)
set(consumer ${WORK_DIR}/consumer)
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(expect_file path)
  if(NOT EXISTS ${prefix}/${path})
    message(FATAL_ERROR "not installed: ${path}")
  endif()
endfunction()

# What flies, alone.
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component programs)
foreach(program swiftlet swiftlet-plant swiftlet-mocap swiftlet-control)
  run(${prefix}/bin/${program} --help)
endforeach()
expect_file(share/swiftlet/config/vehicles/kaylion.yaml)
expect_file(share/swiftlet/config/missions/square.yaml)
expect_file(share/man/man1/swiftlet.1)
expect_file(share/man/man1/swiftlet-sim-fly.1)
expect_file(share/bash-completion/completions/swiftlet)
expect_file(share/zsh/site-functions/_swiftlet)
if(EXISTS ${prefix}/include)
  message(FATAL_ERROR "headers came with the programs")
endif()

# The rest, to build on.
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
expect_file(share/swiftlet/idl/swiftlet_msgs/msg/Imu.idl)
set(flags "")
set(linked "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
  set(linked ${WORK_DIR}/sanitizer_options.o)  # in every program of such a build
  run(${CXX} ${flags} -c ${SANITIZER_OPTIONS} -o ${linked})
endif()
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${consumer} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_CXX_FLAGS=${flags}
  -DCMAKE_EXE_LINKER_FLAGS=${linked} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${consumer})
run(${consumer}/design_and_step ${prefix}/share/swiftlet/config)
run(${consumer}/read_mission ${prefix}/share/swiftlet/config)
execute_process(COMMAND ${consumer}/fly_square nobody 229 --localhost-only RESULT_VARIABLE alone ERROR_VARIABLE said)
if(NOT alone EQUAL 1 OR NOT said MATCHES "no control service for vehicle nobody in domain 229")
  message(FATAL_ERROR "the example said: ${said}")
endif()

# Builds a separate project against the installed package and runs it.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(consumer ${WORK_DIR}/consumer)
file(REMOVE_RECURSE ${consumer})
set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
  run(${CXX} ${flags} -c ${SOURCE_DIR}/cmake/sanitizer_options.cpp -o ${linked})
endif()
run(${CMAKE_COMMAND} -S ${TEST_DIR}/consumer -B ${consumer} ${configuration} -DCMAKE_CXX_FLAGS=${flags}
  -DCMAKE_EXE_LINKER_FLAGS=${linked} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${consumer} --target design_and_step read_mission)
run(${consumer}/design_and_step ${prefix}/share/swiftlet/config)
run(${consumer}/read_mission ${prefix}/share/swiftlet/config)

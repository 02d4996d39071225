# Run by CTest; CMakeLists.txt in this folder sets the variables.
set(prefix ${WORK_DIR}/prefix)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Options for projects of others: Debug, independent of this build.
set(linked "")
if(SANITIZE)
  set(linked ${WORK_DIR}/sanitizer_options.o)  # linked into every program of a sanitizer build
endif()
set(configuration -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=${CXX})
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${LAUNCHER}")

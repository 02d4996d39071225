# Run by CTest: see CMakeLists.txt beside it for the variables.
set(prefix ${WORK_DIR}/prefix)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# What a project of others is configured with: Debug, whatever this build is.
set(linked "")
if(SANITIZE)
  set(linked ${WORK_DIR}/sanitizer_options.o)  # in every program of such a build
endif()
set(configuration -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=${CXX})
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${LAUNCHER}")

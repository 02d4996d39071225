# Functions that create every target of the project, with the same language level, warnings, sanitizers and install rules.

option(SWIFTLET_WERROR "Treat warnings as errors" ${PROJECT_IS_TOP_LEVEL})
option(SWIFTLET_FUZZERS "Build only the fuzzers; requires Clang" OFF)
set(SWIFTLET_SANITIZE "" CACHE STRING "Sanitizers to build with: the argument of -fsanitize=")

add_library(swiftlet_flags INTERFACE)
target_compile_features(swiftlet_flags INTERFACE cxx_std_17)
target_compile_options(swiftlet_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wcast-qual
  -ffp-contract=off  # same result on every machine: lockstep runs are compared bit by bit
  -fno-math-errno -fno-trapping-math  # no code reads errno after a math function or the floating-point exception flags
  $<$<BOOL:${SWIFTLET_WERROR}>:-Werror>)
if(SWIFTLET_FAST_DDS STREQUAL fastdds)  # brings it to its users; precompiled headers need it everywhere
  target_compile_definitions(swiftlet_flags INTERFACE _FILE_OFFSET_BITS=64)
endif()
if(SWIFTLET_SANITIZE)
  # A sanitizer error ends the program, so that the test fails. Without the checks of GCC for null pointers, which AddressSanitizer
  # reports as well, and for alignment, which x86-64 does not need and the fuzzers check, the compiler takes half the time.
  target_compile_options(swiftlet_flags INTERFACE
    -fsanitize=${SWIFTLET_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=null,alignment>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # false positives in instrumented code
  target_link_options(swiftlet_flags INTERFACE -fsanitize=${SWIFTLET_SANITIZE})
  target_sources(swiftlet_flags INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${PROJECT_SOURCE_DIR}/cmake/sanitizer_options.cpp>)
endif()
if(SWIFTLET_FUZZERS)
  target_compile_options(swiftlet_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# Precompiled headers: the standard library and Eigen for the libraries, plus GoogleTest for the tests. Every file still includes
# what it uses: ./dev lint compiles without precompiled headers.
option(SWIFTLET_PRECOMPILED_HEADERS "Precompile the headers of the standard library, Eigen and GoogleTest" ${PROJECT_IS_TOP_LEVEL})

# swiftlet_add_precompiled_headers(NAME HEADERS LIBS ...): adds the target swiftlet_NAME, which precompiles cmake/HEADERS.hpp. Other
# targets reuse it; they are compiled with its optimisation, whatever their own is.
function(swiftlet_add_precompiled_headers name headers)
  add_library(swiftlet_${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/${headers}.cpp)
  target_precompile_headers(swiftlet_${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/${headers}.hpp)
  target_link_libraries(swiftlet_${name} PRIVATE ${ARGN} swiftlet_flags)
endfunction()

# Code that runs for each IMU sample: the compiler inlines more, which saves a fifth of the controller's step.
set(SWIFTLET_EACH_SAMPLE_OPTIONS $<$<CONFIG:RelWithDebInfo,Release>:-O3> -fno-semantic-interposition)

if(SWIFTLET_PRECOMPILED_HEADERS)
  target_compile_options(swiftlet_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # what ccache needs
  swiftlet_add_precompiled_headers(library_headers library_headers Eigen3::Eigen)
  swiftlet_add_precompiled_headers(each_sample_headers library_headers Eigen3::Eigen)
  target_compile_options(swiftlet_each_sample_headers PRIVATE ${SWIFTLET_EACH_SAMPLE_OPTIONS})
  set_target_properties(swiftlet_library_headers swiftlet_each_sample_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()

# Headers are included as <swiftlet/FOLDER/...> in the build tree and after installation.
set(SWIFTLET_HEADER_FOLDERS math plant control recording identification io simulation services ground)
set(SWIFTLET_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
foreach(folder IN LISTS SWIFTLET_HEADER_FOLDERS)
  file(MAKE_DIRECTORY ${SWIFTLET_INCLUDE_DIR}/swiftlet)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${SWIFTLET_INCLUDE_DIR}/swiftlet/${folder} SYMBOLIC)
endforeach()

# swiftlet_add_library(NAME [EACH_SAMPLE] [SOURCES ...] [PUBLIC ...] [PRIVATE ...]): adds a static library swiftlet_NAME with the
# alias swiftlet::NAME, installed and exported. PUBLIC and PRIVATE list link libraries.
#   EACH_SAMPLE  its code runs for each IMU sample
function(swiftlet_add_library name)
  cmake_parse_arguments(arg "EACH_SAMPLE" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target swiftlet_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(swiftlet::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${SWIFTLET_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:swiftlet_flags>)
  set(headers library_headers)
  if(arg_EACH_SAMPLE)
    set(headers each_sample_headers)
    target_compile_options(${target} PRIVATE ${SWIFTLET_EACH_SAMPLE_OPTIONS})
  endif()
  if(SWIFTLET_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM swiftlet_${headers})
  endif()
  swiftlet_export(${name} ${arg_PUBLIC} ${arg_PRIVATE})
endfunction()

# swiftlet_export(NAME LIBS ...): makes the library swiftlet_NAME a component of the installed package, which finds the packages of
# the libraries LIBS.
function(swiftlet_export name)
  set(components "")
  set(packages "")
  foreach(library IN LISTS ARGN)
    if(library MATCHES "^swiftlet::(.+)$")
      list(APPEND components ${CMAKE_MATCH_1})
    elseif(library MATCHES "^([A-Za-z0-9_-]+)(::.+)?$")
      list(APPEND packages ${CMAKE_MATCH_1})
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY SWIFTLET_LIBRARIES swiftlet_${name})
  string(CONCAT component
    "list(APPEND swiftlet_components ${name})\n"
    "set(swiftlet_${name}_uses ${components})\n"
    "set(swiftlet_${name}_needs ${packages})\n")
  set_property(GLOBAL APPEND_STRING PROPERTY SWIFTLET_COMPONENTS "${component}")
endfunction()

# swiftlet_add_executable(NAME SOURCES ... LIBS ...): adds an installed program bin/NAME.
function(swiftlet_add_executable name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} swiftlet_flags)
  set_property(GLOBAL APPEND PROPERTY SWIFTLET_EXECUTABLES ${name})
endfunction()

# Time-out of a test, s: twenty times the duration of the slowest test when it runs alone. Sanitizers make tests ten times slower.
set(SWIFTLET_TEST_TIMEOUT 200)
if(SWIFTLET_SANITIZE)
  set(SWIFTLET_TEST_TIMEOUT 1000)
endif()

# What a test takes of the computer, in sixths of a core: PROCESSORS, with which `ctest --parallel` counts. What computes counts less than
# the core that it may take: it can wait, and no core is idle while others start.
set(SWIFTLET_TEST_IDLES 1)     # waits for time-outs
set(SWIFTLET_TEST_WAITS 2)     # flies in real time: 0.2 to 0.35 of a core
set(SWIFTLET_TEST_COMPUTES 4)  # or measures how quickly something happens: fewer flights beside it

# swiftlet_add_test(NAME SOURCES ... LIBS ... [LABEL label] [SHARDS n] [CASES_APART] [WAITS | IDLES] [CALM filter] [ALONE filter]):
# adds a GoogleTest program.
#   LABEL        CTest label; the default `unit` also adds the program to the target unit_tests
#   SHARDS       number of CTest tests that share the test cases; the default is one test
#   CASES_APART  each test case is a CTest test with its own process, for cases that take seconds
#   WAITS, IDLES how much the program computes, see above; the default is SWIFTLET_TEST_COMPUTES
#   CALM         GoogleTest filter of the cases that measure how quickly something happens (needs CASES_APART)
#   ALONE        GoogleTest filter of the cases with which nothing runs in parallel (needs CASES_APART)
function(swiftlet_add_test name)
  cmake_parse_arguments(arg "CASES_APART;WAITS;IDLES" "LABEL;SHARDS;CALM;ALONE" "SOURCES;LIBS" ${ARGN})
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  add_executable(${name} ${arg_SOURCES})
  add_dependencies(tests ${name})
  if(arg_LABEL STREQUAL unit)
    add_dependencies(unit_tests ${name})
  endif()
  target_link_libraries(${name} PRIVATE ${arg_LIBS} GTest::gtest GTest::gtest_main swiftlet_flags)
  target_compile_options(${name} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O1>)  # only the code under test needs -O2
  if(SWIFTLET_PRECOMPILED_HEADERS)
    target_precompile_headers(${name} REUSE_FROM swiftlet_test_headers)
  endif()
  target_compile_definitions(${name} PRIVATE
    SWIFTLET_SOURCE_DIR="${PROJECT_SOURCE_DIR}" SWIFTLET_BIN_DIR="${PROJECT_BINARY_DIR}/bin")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  set(properties LABELS ${arg_LABEL} TIMEOUT ${SWIFTLET_TEST_TIMEOUT} ENVIRONMENT_MODIFICATION "ROS_DOMAIN_ID=unset:")
  set(processors ${SWIFTLET_TEST_COMPUTES})
  if(arg_WAITS)
    set(processors ${SWIFTLET_TEST_WAITS})
  elseif(arg_IDLES)
    set(processors ${SWIFTLET_TEST_IDLES})
  endif()
  list(APPEND properties PROCESSORS ${processors})
  if(arg_SHARDS)
    foreach(shard RANGE 1 ${arg_SHARDS})
      math(EXPR index "${shard} - 1")
      add_test(NAME ${name}.${shard} COMMAND ${name})
      set_tests_properties(${name}.${shard} PROPERTIES ${properties}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${index}")
    endforeach()
    return()
  endif()
  if(NOT arg_CASES_APART)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES ${properties})
    return()
  endif()
  set(cases TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST)
  gtest_discover_tests(${name} ${cases} TEST_FILTER "-${arg_CALM}:${arg_ALONE}" PROPERTIES ${properties})
  if(arg_CALM)
    gtest_discover_tests(${name} ${cases} TEST_FILTER "${arg_CALM}" PROPERTIES ${properties} PROCESSORS ${SWIFTLET_TEST_COMPUTES})
  endif()
  if(arg_ALONE)
    gtest_discover_tests(${name} ${cases} TEST_FILTER "${arg_ALONE}" PROPERTIES ${properties} RUN_SERIAL ON)
  endif()
endfunction()

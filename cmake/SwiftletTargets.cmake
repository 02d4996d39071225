# Functions that create every target of the project, with the same language level, warnings, sanitizers and install rules.

option(SWIFTLET_WERROR "Treat warnings as errors" ${PROJECT_IS_TOP_LEVEL})
option(SWIFTLET_FUZZERS "Build only the fuzzers; requires Clang" OFF)
set(SWIFTLET_SANITIZE "" CACHE STRING "Sanitizers to build with: the argument of -fsanitize=")

option(SWIFTLET_PRECOMPILED_HEADERS "Precompile the headers of the libraries and of GoogleTest" ${PROJECT_IS_TOP_LEVEL})

add_library(swiftlet_flags INTERFACE)
target_compile_features(swiftlet_flags INTERFACE cxx_std_17)
target_compile_options(swiftlet_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wcast-qual
  -ffp-contract=off  # same result on every machine: lockstep runs are compared bit by bit
  -fno-math-errno -fno-trapping-math  # no code reads errno after a math function or the floating-point exception flags
  $<$<BOOL:${SWIFTLET_WERROR}>:-Werror>)
if(SWIFTLET_PRECOMPILED_HEADERS)  # what fmt defines for its users; the precompiled headers need it everywhere
  target_compile_definitions(swiftlet_flags INTERFACE $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
endif()
if(SWIFTLET_FAST_DDS STREQUAL fastdds)  # brings it to its users; precompiled headers need it everywhere
  target_compile_definitions(swiftlet_flags INTERFACE _FILE_OFFSET_BITS=64)
endif()
# Sanitizers double the time of the compiler. What only computes with numbers of its own is compiled without AddressSanitizer: the
# assertions of Eigen check its indices.
set(SWIFTLET_COMPUTING_ROOMS math plant identification simulation
  control/types control/design control/position control/estimation)
set(SWIFTLET_SANITIZES_SOME OFF)
if(SWIFTLET_SANITIZE MATCHES address AND NOT SWIFTLET_FUZZERS)
  set(SWIFTLET_SANITIZES_SOME ON)
endif()

if(SWIFTLET_SANITIZE)
  # A sanitizer error ends the program, so that the test fails. Without the checks of GCC for null pointers, which AddressSanitizer
  # reports as well, and for alignment, which x86-64 does not need and the fuzzers check, the compiler takes half the time.
  # What is compiled without frees what is compiled with allocates: the same way.
  target_compile_definitions(swiftlet_flags INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=0)
  set(sanitized $<NOT:$<BOOL:$<TARGET_PROPERTY:SWIFTLET_UNSANITIZED>>>)
  target_compile_options(swiftlet_flags INTERFACE
    $<${sanitized}:-fsanitize=${SWIFTLET_SANITIZE}> $<${sanitized}:-fno-sanitize-recover=all> -fno-omit-frame-pointer
    $<$<AND:${sanitized},$<CXX_COMPILER_ID:GNU>>:-fno-sanitize=null,alignment>
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

# swiftlet_add_precompiled_headers(NAME HEADERS LIBS ...): adds the target swiftlet_NAME, which precompiles cmake/HEADERS.hpp. Other
# targets reuse it; they are compiled with its optimisation, whatever their own is.
function(swiftlet_add_precompiled_headers name headers)
  add_library(swiftlet_${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/${headers}.cpp)
  target_include_directories(swiftlet_${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake)
  # By its full path, the compiler cache would serve only one work tree.
  target_precompile_headers(swiftlet_${name} PRIVATE <${headers}.hpp>)
  target_link_libraries(swiftlet_${name} PRIVATE ${ARGN} swiftlet_flags)
endfunction()

# Unity build: the compiler reads several files of a target as one unit and parses the headers that they share once, which halves its
# time. So the files of a target must not repeat a name in their anonymous namespaces, and no file may leave a macro behind. ./dev lint
# compiles each file alone.
option(SWIFTLET_UNITY_BUILD "Compile several files of a target as one" ${PROJECT_IS_TOP_LEVEL})
if(SWIFTLET_UNITY_BUILD)  # it takes each file for a header, whose types must not have members of anonymous namespaces
  target_compile_options(swiftlet_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()

# swiftlet_units(OUT NAME SOURCES ... [APART ...] [FILES n]): sets OUT to what is to be compiled for the sources of the target NAME: one
# unit, or units of at most n files each, of about equal number, and the files of APART and generated ones by themselves. Unlike those of CMake's
# UNITY_BUILD, the units name no folder of this computer, so that the compiler cache serves several work trees.
function(swiftlet_units out name)
  cmake_parse_arguments(arg "" "FILES" "SOURCES;APART" ${ARGN})
  if(NOT SWIFTLET_UNITY_BUILD)
    set(${out} ${arg_SOURCES} ${arg_APART} PARENT_SCOPE)
    return()
  endif()
  set(units ${arg_APART})
  set(joined)
  foreach(source IN LISTS arg_SOURCES)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE file)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${file}" is_generated)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    if(is_generated)
      list(APPEND units ${source})
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)  # a second less for a small file
    elseif(file MATCHES "^tests/")
      list(APPEND joined "${file}")
    else()
      list(APPEND joined "swiftlet/${file}")
    endif()
  endforeach()
  list(LENGTH joined files)
  if(NOT arg_FILES)
    set(arg_FILES 1000)  # all in one
  endif()
  math(EXPR number "(${files} + ${arg_FILES} - 1) / ${arg_FILES}")
  set(unit 0)
  while(unit LESS number)
    set(text "")
    math(EXPR first "${unit} * ${files} / ${number}")
    math(EXPR end "(${unit} + 1) * ${files} / ${number}")
    while(first LESS end)
      list(GET joined ${first} file)
      string(APPEND text "#include \"${file}\"\n")
      math(EXPR first "${first} + 1")
    endwhile()
    set(file ${CMAKE_CURRENT_BINARY_DIR}/units/${name}_${unit}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
    list(APPEND units ${file})
    math(EXPR unit "${unit} + 1")
  endwhile()
  set(${out} ${units} PARENT_SCOPE)
endfunction()

# Code that runs for each IMU sample: the compiler inlines more, which saves a fifth of the controller's step.
set(SWIFTLET_EACH_SAMPLE_OPTIONS $<$<CONFIG:RelWithDebInfo,Release>:-O3> -fno-semantic-interposition)
# In the presets only, a package is built with Release. Code that runs once a command: the compiler takes half the time. Code that neither
# runs for each sample nor fits or plans: it takes three quarters.
set(SWIFTLET_ONCE_OPTIONS $<$<CONFIG:RelWithDebInfo,Debug>:-O0>)
set(SWIFTLET_LIGHT_OPTIONS $<$<CONFIG:RelWithDebInfo>:-O1> $<$<CONFIG:Debug>:-O0>)

if(SWIFTLET_PRECOMPILED_HEADERS)
  target_compile_options(swiftlet_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # what ccache needs
  set(light_libs Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json)
  swiftlet_add_precompiled_headers(library_headers library_headers Eigen3::Eigen)
  swiftlet_add_precompiled_headers(each_sample_headers library_headers Eigen3::Eigen)
  target_compile_options(swiftlet_each_sample_headers PRIVATE ${SWIFTLET_EACH_SAMPLE_OPTIONS})
  swiftlet_add_precompiled_headers(once_headers light_headers ${light_libs})
  target_compile_options(swiftlet_once_headers PRIVATE ${SWIFTLET_ONCE_OPTIONS})
  swiftlet_add_precompiled_headers(light_headers light_headers ${light_libs})
  target_compile_options(swiftlet_light_headers PRIVATE ${SWIFTLET_LIGHT_OPTIONS})
  set_target_properties(swiftlet_library_headers swiftlet_each_sample_headers swiftlet_once_headers swiftlet_light_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set_target_properties(swiftlet_library_headers swiftlet_each_sample_headers PROPERTIES SWIFTLET_UNSANITIZED ${SWIFTLET_SANITIZES_SOME})
endif()

# Headers are included as <swiftlet/FOLDER/...> in the build tree and after installation.
set(SWIFTLET_HEADER_FOLDERS math plant control record identification io simulation services ground analysis)
set(SWIFTLET_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
foreach(folder IN LISTS SWIFTLET_HEADER_FOLDERS)
  file(MAKE_DIRECTORY ${SWIFTLET_INCLUDE_DIR}/swiftlet)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${SWIFTLET_INCLUDE_DIR}/swiftlet/${folder} SYMBOLIC)
endforeach()

# swiftlet_add_library(NAME [EACH_SAMPLE | ONCE | COMPUTES] SOURCES ... [APART ...] [PUBLIC ...] [PRIVATE ...]): adds a static library swiftlet_NAME
# with the alias swiftlet::NAME, installed and exported. PUBLIC and PRIVATE list link libraries.
#   EACH_SAMPLE  its code runs for each IMU sample
#   ONCE         its code runs once a command
#   COMPUTES     it fits, plans or simulates: optimised as the preset has it
#   APART        further sources, each of which takes the compiler as long as several others: a unit of its own
function(swiftlet_add_library name)
  cmake_parse_arguments(arg "EACH_SAMPLE;ONCE;COMPUTES" "" "SOURCES;APART;PUBLIC;PRIVATE" ${ARGN})
  set(target swiftlet_${name})
  swiftlet_units(units ${name} SOURCES ${arg_SOURCES} APART ${arg_APART})
  add_library(${target} STATIC ${units})
  add_library(swiftlet::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${SWIFTLET_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:swiftlet_flags>)
  if(SWIFTLET_SANITIZES_SOME)  # the room decides, not how often the code runs
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
    list(JOIN SWIFTLET_COMPUTING_ROOMS "|" rooms)
    if("${folder}/" MATCHES "^(${rooms})/")
      set_target_properties(${target} PROPERTIES SWIFTLET_UNSANITIZED ON)
      set(arg_COMPUTES ON)
    else()
      set(arg_COMPUTES OFF)
      set(arg_EACH_SAMPLE OFF)
    endif()
    set(arg_ONCE OFF)
  endif()
  set(headers light_headers)
  if(arg_COMPUTES)
    set(headers library_headers)
  elseif(arg_EACH_SAMPLE)
    set(headers each_sample_headers)
    target_compile_options(${target} PRIVATE ${SWIFTLET_EACH_SAMPLE_OPTIONS})
  elseif(arg_ONCE)
    set(headers once_headers)
    target_compile_options(${target} PRIVATE ${SWIFTLET_ONCE_OPTIONS})
  else()
    target_compile_options(${target} PRIVATE ${SWIFTLET_LIGHT_OPTIONS})
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

# swiftlet_add_executable(NAME SOURCES main.cpp ... LIBS ...): adds an installed program bin/NAME. Its sources but the first are the library
# NAME-parts, which its tests link as well.
function(swiftlet_add_executable name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  list(POP_FRONT arg_SOURCES main)
  add_executable(${name} ${main})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} swiftlet_flags)
  target_compile_options(${name} PRIVATE ${SWIFTLET_LIGHT_OPTIONS})
  if(SWIFTLET_PRECOMPILED_HEADERS AND NOT arg_SOURCES)
    target_compile_options(${name} PRIVATE -fPIC)  # as the headers
    target_precompile_headers(${name} REUSE_FROM swiftlet_light_headers)
  endif()
  if(arg_SOURCES)
    set(parts ${name}-parts)
    swiftlet_units(units ${parts} SOURCES ${arg_SOURCES})
    add_library(${parts} STATIC ${units})
    target_link_libraries(${parts} PUBLIC ${arg_LIBS} PRIVATE swiftlet_flags)
    target_compile_options(${parts} PRIVATE ${SWIFTLET_LIGHT_OPTIONS})
    set_target_properties(${parts} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(SWIFTLET_PRECOMPILED_HEADERS)
      target_precompile_headers(${parts} REUSE_FROM swiftlet_light_headers)
    endif()
    target_link_libraries(${name} PRIVATE ${parts})
  endif()
  set_property(GLOBAL APPEND PROPERTY SWIFTLET_EXECUTABLES ${name})
endfunction()

# Time-out of a test, s: what hangs ends before it (kStuck of tests/support/eventually.hpp). Sanitizers make tests ten times slower.
set(SWIFTLET_TEST_TIMEOUT 400)
if(SWIFTLET_SANITIZE)
  set(SWIFTLET_TEST_TIMEOUT 1000)
endif()

# What a test takes of the computer, in sixths of a core: PROCESSORS, with which `ctest --parallel` counts.
set(SWIFTLET_TEST_WAITS 2)       # mostly for time-outs
set(SWIFTLET_TEST_COMPUTES 4)    # it can wait, and no core is idle while others start
set(SWIFTLET_TEST_WALL_CLOCK 6)  # flies in real time: ./dev runs these apart, beside each other only

option(SWIFTLET_MEASURE_TESTS "Count the CPU seconds of the tests, for ./dev weight" OFF)

# swiftlet_add_test_program(NAME SOURCES ... LIBS ...): adds a GoogleTest program, without tests of CTest.
function(swiftlet_add_test_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  swiftlet_units(units ${name} SOURCES ${arg_SOURCES} FILES 20)  # for which the compiler takes some 40 s and 1.2 GB
  add_executable(${name} ${units})
  add_dependencies(tests ${name})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} GTest::gtest GTest::gtest_main swiftlet_test_paths swiftlet_flags)
  target_compile_options(${name} PRIVATE ${SWIFTLET_LIGHT_OPTIONS})  # only the code under test needs -O2
  if(SWIFTLET_PRECOMPILED_HEADERS)
    target_precompile_headers(${name} REUSE_FROM swiftlet_test_headers)
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  if(SWIFTLET_MEASURE_TESTS)
    set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR
      "python3;-ISB;${PROJECT_SOURCE_DIR}/tests/weight/measure.py;${PROJECT_BINARY_DIR}/weight/tests.log")
  endif()
endfunction()

# swiftlet_test_properties(OUT LABEL WAITS): sets OUT to the properties of a test of CTest.
function(swiftlet_test_properties out label waits)
  set(processors ${SWIFTLET_TEST_COMPUTES})
  if(waits)
    set(processors ${SWIFTLET_TEST_WAITS})
  endif()
  set(${out} LABELS ${label} TIMEOUT ${SWIFTLET_TEST_TIMEOUT} ENVIRONMENT_MODIFICATION "ROS_DOMAIN_ID=unset:" PROCESSORS ${processors} PARENT_SCOPE)
endfunction()

# swiftlet_discover_cases(PROGRAM PREFIX CASES QUICK WALL_CLOCK properties ...): makes each case of a GoogleTest program that the filter CASES
# takes the test PREFIX.CASE, with its own process.
#   QUICK       filter of the cases that `./dev test` runs, one of each capability: CTest label `flight`
#   WALL_CLOCK  filter of the cases that wait for the wall clock, which tests/README.md lists: label `wall_clock`
function(swiftlet_discover_cases program prefix cases quick wall_clock)
  set(options TEST_PREFIX "${prefix}." DISCOVERY_MODE PRE_TEST)
  gtest_discover_tests(${program} ${options} TEST_FILTER "${cases}-${quick}:${wall_clock}" PROPERTIES ${ARGN})
  if(quick)
    add_dependencies(quick_tests ${program})
    gtest_discover_tests(${program} ${options} TEST_FILTER "${quick}-${wall_clock}" PROPERTIES ${ARGN} LABELS flight)
  endif()
  if(wall_clock)
    gtest_discover_tests(${program} ${options} TEST_FILTER "${wall_clock}"
      PROPERTIES ${ARGN} LABELS wall_clock PROCESSORS ${SWIFTLET_TEST_WALL_CLOCK})
  endif()
endfunction()

# swiftlet_add_test(NAME SOURCES ... LIBS ... [LABEL label] [ROOM room] [SHARDS n] [CASES_APART] [WAITS] [WALL_CLOCK filter]
# [UNSANITIZED filter]): adds a GoogleTest program.
#   LABEL        CTest label; the default `unit` also adds the program to the target unit_tests
#   ROOM         the room that it tests: adds the CTest label room_ROOM
#   SHARDS       number of CTest tests that share the test cases; the default is one test
#   CASES_APART  each test case is a CTest test with its own process, for cases that take seconds
#   WAITS        it mostly waits for time-outs
#   WALL_CLOCK   filter of the cases that wait for the wall clock, which tests/README.md lists: label `wall_clock` (needs CASES_APART or
#                SHARDS)
#   UNSANITIZED  filter of the cases that make often what others make once: left out with sanitizers, which make it ten times slower
function(swiftlet_add_test name)
  cmake_parse_arguments(arg "CASES_APART;WAITS" "LABEL;ROOM;SHARDS;WALL_CLOCK;UNSANITIZED" "SOURCES;LIBS" ${ARGN})
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  swiftlet_add_test_program(${name} SOURCES ${arg_SOURCES} LIBS ${arg_LIBS})
  if(arg_LABEL STREQUAL unit)
    add_dependencies(unit_tests ${name})
  endif()
  swiftlet_test_properties(properties ${arg_LABEL} "${arg_WAITS}")
  if(arg_CASES_APART)
    swiftlet_discover_cases(${name} ${name} "*" "" "${arg_WALL_CLOCK}" ${properties})
    return()
  endif()
  set(apart "${arg_WALL_CLOCK}")
  if(SWIFTLET_SANITIZE)
    string(APPEND apart ":${arg_UNSANITIZED}")
  endif()
  if(arg_SHARDS)
    set(tests)
    foreach(shard RANGE 1 ${arg_SHARDS})
      math(EXPR index "${shard} - 1")
      list(APPEND tests ${name}.${shard})
      add_test(NAME ${name}.${shard} COMMAND ${name} "--gtest_filter=-${apart}")
      set_tests_properties(${name}.${shard} PROPERTIES ${properties}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${index}")
    endforeach()
    if(arg_WALL_CLOCK)
      list(APPEND tests ${name}.wall_clock)
      add_test(NAME ${name}.wall_clock COMMAND ${name} --gtest_filter=${arg_WALL_CLOCK})
      set_tests_properties(${name}.wall_clock PROPERTIES ${properties} LABELS wall_clock PROCESSORS ${SWIFTLET_TEST_WALL_CLOCK})
    endif()
  else()
    set(tests ${name})
    add_test(NAME ${name} COMMAND ${name} "--gtest_filter=-${apart}")
    set_tests_properties(${name} PROPERTIES ${properties})
  endif()
  if(arg_ROOM)
    set_property(TEST ${tests} APPEND PROPERTY LABELS room_${arg_ROOM})
  endif()
endfunction()

# Install rules, in two components: `programs` (executables and configuration, to fly) and `development` (libraries, headers, IDL
# and the CMake package for find_package(swiftlet), to build on).

include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY SWIFTLET_LIBRARIES)

install(TARGETS ${executables} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
install(DIRECTORY config DESTINATION ${CMAKE_INSTALL_DATADIR}/swiftlet COMPONENT programs)

install(TARGETS ${libraries} EXPORT swiftletTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
foreach(folder IN LISTS SWIFTLET_HEADER_FOLDERS)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/swiftlet COMPONENT development
    FILES_MATCHING PATTERN "*.hpp")
endforeach()

get_property(components GLOBAL PROPERTY SWIFTLET_COMPONENTS)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/swiftlet)
configure_package_config_file(cmake/swiftletConfig.cmake.in ${PROJECT_BINARY_DIR}/swiftletConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/swiftletConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT swiftletTargets NAMESPACE swiftlet:: DESTINATION ${package_dir} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/swiftletConfig.cmake ${PROJECT_BINARY_DIR}/swiftletConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT development)

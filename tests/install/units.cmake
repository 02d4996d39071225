# The systemd units: what systemd says of them, and how much of the system they leave to the programs (2.5 of 10).
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(units ${WORK_DIR}/units)
file(REMOVE_RECURSE ${units})
file(COPY ${SOURCE_DIR}/debian/units/ DESTINATION ${units})
file(GLOB services ${units}/*.service)
foreach(service IN LISTS services)  # with the programs of this build
  file(READ ${service} text)
  string(REPLACE "=/usr/bin/" "=${BUILD_DIR}/bin/" text "${text}")
  file(WRITE ${service} "${text}")
endforeach()

set(ENV{SYSTEMD_UNIT_PATH} ${units}:)  # then those of the system
foreach(unit swiftlet-control@kl1 swiftlet-mocap swiftlet-px4@kl1)
  run(systemd-analyze verify ${unit}.service)
  run(systemd-analyze security --offline=true --threshold=25 --no-pager ${unit}.service)
endforeach()

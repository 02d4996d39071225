# Writes OUT, the source of version_text(), from VERSION and the commit of the sources in SOURCE. Runs at every build, and leaves an
# unchanged file alone.
find_program(GIT git)
set(commit "")
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --abbrev=10 --dirty --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(commit)
  set(commit ", commit ${commit}")
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::runtime {

const char* version_text() { return "swiftlet @VERSION@@commit@"; }

}  // namespace swiftlet::runtime
]])

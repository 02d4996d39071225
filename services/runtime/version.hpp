#pragma once

namespace swiftlet::runtime {

// "swiftlet 0.1.0, commit 3eaa033f9c"; "-dirty" follows if files differed from the commit, and nothing the version
// if the sources are in no repository.
const char* version_text();

}  // namespace swiftlet::runtime

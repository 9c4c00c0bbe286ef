# Run at every build, so that a commit or an edit after the last configuration is seen: -D SOURCE=... -D OUTPUT=...
# The source is written only when it changes.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git describe --always --dirty=+ --abbrev=9 --exclude=* WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT revision)
  set(revision unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#include \"base/version.hpp\"

namespace calx {
const char* git_revision() { return \"${revision}\"; }
}  // namespace calx
")

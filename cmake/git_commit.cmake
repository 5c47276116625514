# cmake -DSOURCE_DIR=... -DOUTPUT=... -P git_commit.cmake: writes a header with the current commit. Runs in every build;
# the file changes only when the commit does.
execute_process(
  COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET
  RESULT_VARIABLE status
)
if(NOT status STREQUAL "0" OR commit STREQUAL "")
  set(commit "unknown")
endif()
set(text "#define TANDEM_GIT_COMMIT \"${commit}\"\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${OUTPUT} "${text}")
endif()

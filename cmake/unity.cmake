# With TANDEM_UNITY files that read the same large headers are compiled together: most of the time to compile one of them
# goes into those headers and into templates that its neighbours instantiate too (docs/performance/build-time.md).

if(TANDEM_UNITY)
  # g++ collects garbage as often as small files need; in these files that takes a tenth of the time.
  add_compile_options(
    "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param=ggc-min-heapsize=1000000 --param=ggc-min-expand=200>"
  )
endif()

# tandem_compile_together(TARGET PATTERN [MOST]): the sources of TARGET that match, in equal parts of at most MOST files,
# 30 by default
function(tandem_compile_together target pattern)
  set(most 30)
  if(ARGC GREATER 2)
    set(most ${ARGV2})
  endif()
  if(NOT TANDEM_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(files ${target} SOURCES)
  list(FILTER files INCLUDE REGEX "${pattern}")
  string(MAKE_C_IDENTIFIER "${pattern}" name)
  list(LENGTH files count)
  math(EXPR groups "(${count} + ${most} - 1) / ${most}")
  set(number 0)
  foreach(file IN LISTS files)
    math(EXPR group "${number} * ${groups} / ${count}")
    set_source_files_properties(${file} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name}_${group})
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()

# With TANDEM_UNITY the files of a folder that read the same large headers are compiled together, seven at a time.

# tandem_compile_together(TARGET PATTERN): the sources of TARGET that match
function(tandem_compile_together target pattern)
  if(NOT TANDEM_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(files ${target} SOURCES)
  list(FILTER files INCLUDE REGEX "${pattern}")
  string(MAKE_C_IDENTIFIER "${pattern}" name)
  set(number 0)
  foreach(file IN LISTS files)
    math(EXPR group "${number} / 7")
    set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${name}_${group})
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()

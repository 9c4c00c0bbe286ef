# calx_scene_test(MODULE FILE PLUGINS targets...): a test that runs whole cases, from test_FILE.cpp. It exists where all
# plugins it names exist, so that any plugin folder may be deleted.
find_package(OpenMP REQUIRED COMPONENTS CXX)
function(calx_scene_test name file)
  cmake_parse_arguments(A "" "" "PLUGINS" ${ARGN})
  foreach(plugin ${A_PLUGINS})
    if(NOT TARGET ${plugin})
      return()
    endif()
  endforeach()
  calx_test(${name}_${file} SOURCES test_${file}.cpp LINKS calx_sim OpenMP::OpenMP_CXX)
  add_dependencies(test_${name}_${file} ${A_PLUGINS})
  # As the calx program does: threads that wait on a busy machine give their core away.
  set_tests_properties(${name}_${file} PROPERTIES ENVIRONMENT GOMP_SPINCOUNT=10000)
endfunction()

# calx_add_plugin(NAME SOURCES ... [LAWS x.law.h ...] [INCLUDES dirs...] MANIFEST x.plugin.json.in)
#
# Builds one plugin library beside its manifest. Each law text is embedded as a byte array in <law>.inc with its SHA-256 in
# <law>.sha256.inc, both generated into the build folder, so that text and machine code cannot drift apart.
# Flags make laws vectorise without changing any value; -ffast-math is refused because it would flush denormals in the host.
function(calx_add_plugin name)
  cmake_parse_arguments(A "" "MANIFEST" "SOURCES;LAWS;INCLUDES" ${ARGN})
  if("${CMAKE_C_FLAGS} ${CMAKE_CXX_FLAGS}" MATCHES "-ffast-math|-Ofast")
    message(FATAL_ERROR "${name}: -ffast-math changes bits and poisons the host's floating-point state; remove it")
  endif()
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  file(MAKE_DIRECTORY ${out})
  foreach(law ${A_LAWS})
    get_filename_component(law_name ${law} NAME)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${law})
    file(READ ${law} hex HEX)
    file(SHA256 ${law} sha)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "((0x..,){24})" "\\1\n" bytes "${bytes}")
    file(CONFIGURE OUTPUT ${out}/${law_name}.inc CONTENT "${bytes}0\n" @ONLY)
    file(CONFIGURE OUTPUT ${out}/${law_name}.sha256.inc CONTENT "\"${sha}\"\n" @ONLY)
  endforeach()
  add_library(${name} MODULE ${A_SOURCES})
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${out} ${A_INCLUDES}
                             ${PROJECT_SOURCE_DIR}/abi/include ${PROJECT_SOURCE_DIR}/abi/cpp)
  target_compile_features(${name} PRIVATE cxx_std_11 c_std_99)
  target_compile_options(${name} PRIVATE -O3 -fno-math-errno -fno-trapping-math -ffp-contract=off -fopenmp-simd
                         -fvisibility=hidden -Wall -Wextra)
  target_link_options(${name} PRIVATE -Wl,-z,now -Wl,-z,relro -Wl,--exclude-libs,ALL)
  if(NOT CALX_SANITIZE)
    target_link_options(${name} PRIVATE -Wl,-z,defs -static-libgcc -static-libstdc++)
  endif()
  set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${CALX_PLUGIN_DIR})
  # The entry is the only symbol a plugin exports; templates of the static C++ library would leak otherwise, and two
  # plugins in one process could then share each other's copies.
  file(CONFIGURE OUTPUT ${out}/exports.map CONTENT "{ global: calx_plugin_entry; local: *; };\n" @ONLY)
  target_link_options(${name} PRIVATE -Wl,--version-script=${out}/exports.map)
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${out}/exports.map)
  set(CALX_PLUGIN_LIBRARY ${name}${CMAKE_SHARED_MODULE_SUFFIX})
  configure_file(${A_MANIFEST} ${CALX_PLUGIN_DIR}/${name}.plugin.json @ONLY)
  install(TARGETS ${name} LIBRARY DESTINATION lib/calx/plugins)
  install(FILES ${CALX_PLUGIN_DIR}/${name}.plugin.json DESTINATION lib/calx/plugins)
endfunction()

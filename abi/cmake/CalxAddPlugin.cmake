# calx_add_plugin(NAME SOURCES ... [LAWS x.law.h ...] [INCLUDES dirs...] MANIFEST x.plugin.json.in
#                 [FILES files...] [NO_INSTALL])
#
# Builds one plugin library beside its manifest and FILES, in CALX_PLUGIN_DIR (default: <build>/plugins). Each law text is embedded
# as a byte array in <law>.inc with its SHA-256 in <law>.sha256.inc, both generated into the build folder, so that text
# and machine code cannot drift apart. Flags make laws vectorise without changing any value; -ffast-math is refused
# because it would flush denormals in the host.
#
# calx_add_effect(NAME MANIFEST x.plugin.json.in [NO_INSTALL]) does the same for an effect that is a manifest alone.
#
# Also defines Calx::abi, the headers. Works inside Calx, included from its source tree, or through
# find_package(CalxAbi).
if(NOT TARGET Calx::abi)
  add_library(Calx::abi INTERFACE IMPORTED GLOBAL)
  if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/../include/calx/abi.h)  # the source tree
    set_target_properties(Calx::abi PROPERTIES INTERFACE_INCLUDE_DIRECTORIES
      "${CMAKE_CURRENT_LIST_DIR}/../include;${CMAKE_CURRENT_LIST_DIR}/../cpp")
  else()  # installed as <prefix>/lib/cmake/CalxAbi
    get_filename_component(prefix ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
    set_target_properties(Calx::abi PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${prefix}/include)
    unset(prefix)
  endif()
endif()

function(calx_add_plugin name)
  cmake_parse_arguments(A "NO_INSTALL" "MANIFEST" "SOURCES;LAWS;INCLUDES;FILES" ${ARGN})
  if(NOT A_SOURCES OR NOT A_MANIFEST OR A_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "${name}: calx_add_plugin needs SOURCES and MANIFEST (unknown: \"${A_UNPARSED_ARGUMENTS}\")")
  endif()
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  get_directory_property(options COMPILE_OPTIONS)
  if("${CMAKE_C_FLAGS} ${CMAKE_CXX_FLAGS} ${CMAKE_C_FLAGS_${type}} ${CMAKE_CXX_FLAGS_${type}} ${options}" MATCHES
     "-ffast-math|-Ofast|-funsafe-math-optimizations")
    message(FATAL_ERROR "${name}: -ffast-math changes bits and poisons the host's floating-point state; remove it")
  endif()
  if(NOT CALX_PLUGIN_DIR)
    set(CALX_PLUGIN_DIR ${CMAKE_BINARY_DIR}/plugins)
  endif()
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  file(MAKE_DIRECTORY ${out})
  foreach(law ${A_LAWS})
    get_filename_component(law ${law} ABSOLUTE)
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
  target_link_libraries(${name} PRIVATE Calx::abi m)
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${out} ${A_INCLUDES})
  target_compile_features(${name} PRIVATE cxx_std_11 c_std_99)
  target_compile_options(${name} PRIVATE -O3 -fno-math-errno -fno-trapping-math -ffp-contract=off -fopenmp-simd
                         -fvisibility=hidden -Wall -Wextra)
  target_link_options(${name} PRIVATE -Wl,-z,now -Wl,-z,relro -Wl,--exclude-libs,ALL)
  if(CALX_SANITIZE)
    # Sanitizers need the host's runtime, and do not mix with the choice of instruction sets at load.
    target_compile_options(${name} PRIVATE -fsanitize=${CALX_SANITIZE} -fno-omit-frame-pointer)
    target_compile_definitions(${name} PRIVATE CALX_NO_CLONES)
    target_link_options(${name} PRIVATE -fsanitize=${CALX_SANITIZE})
  else()
    target_link_options(${name} PRIVATE -Wl,-z,defs -static-libgcc $<$<LINK_LANGUAGE:CXX>:-static-libstdc++>)
  endif()
  set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${CALX_PLUGIN_DIR})
  # The entry is the only symbol a plugin exports; templates of the static C++ library would leak otherwise, and two
  # plugins in one process could then share each other's copies.
  file(CONFIGURE OUTPUT ${out}/exports.map CONTENT "{ global: calx_plugin_entry; local: *; };\n" @ONLY)
  target_link_options(${name} PRIVATE -Wl,--version-script=${out}/exports.map)
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${out}/exports.map)
  set(CALX_PLUGIN_LIBRARY ${name}${CMAKE_SHARED_MODULE_SUFFIX})
  configure_file(${A_MANIFEST} ${CALX_PLUGIN_DIR}/${name}.plugin.json @ONLY)
  if(A_FILES)
    file(COPY ${A_FILES} DESTINATION ${CALX_PLUGIN_DIR})
  endif()
  if(NOT A_NO_INSTALL)
    install(FILES ${A_FILES} DESTINATION lib/calx/plugins)
    install(TARGETS ${name} LIBRARY DESTINATION lib/calx/plugins)
    install(FILES ${CALX_PLUGIN_DIR}/${name}.plugin.json DESTINATION lib/calx/plugins)
  endif()
endfunction()

# calx_add_effect(NAME MANIFEST x.plugin.json.in [NO_INSTALL]): an effect of edits alone, a manifest without a library, of
# the kind calx.case-effect/1.
function(calx_add_effect name)
  cmake_parse_arguments(A "NO_INSTALL" "MANIFEST" "" ${ARGN})
  if(NOT A_MANIFEST OR A_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "${name}: calx_add_effect needs MANIFEST (unknown: \"${A_UNPARSED_ARGUMENTS}\")")
  endif()
  if(NOT CALX_PLUGIN_DIR)
    set(CALX_PLUGIN_DIR ${CMAKE_BINARY_DIR}/plugins)
  endif()
  add_custom_target(${name})
  configure_file(${A_MANIFEST} ${CALX_PLUGIN_DIR}/${name}.plugin.json @ONLY)
  if(NOT A_NO_INSTALL)
    install(FILES ${CALX_PLUGIN_DIR}/${name}.plugin.json DESTINATION lib/calx/plugins)
  endif()
endfunction()

# Calx's own build also installs the package it is part of.
get_filename_component(calx_abi_owner ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
if("${calx_abi_owner}" STREQUAL "${PROJECT_SOURCE_DIR}")
  include(${CMAKE_CURRENT_LIST_DIR}/CalxAbiInstall.cmake)
endif()
unset(calx_abi_owner)

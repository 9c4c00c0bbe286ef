# Installs headers, find_package(CalxAbi), calx-abi.pc, the templates of calx plugin new, the guide of plugin authors, the page of
# the case file and examples; alone with cmake --install <build> --component abi. The templates lie beside the program of the build tree, too.
include(CMakePackageConfigHelpers)
set(abi ${CMAKE_CURRENT_LIST_DIR}/..)
file(STRINGS ${abi}/include/calx/abi.h lines REGEX "^#define CALX_ABI_(MAJOR|MINOR) ")
string(REGEX REPLACE ".*CALX_ABI_MAJOR ([0-9]+).*CALX_ABI_MINOR ([0-9]+).*" "\\1.\\2" CALX_ABI_VERSION "${lines}")
write_basic_package_version_file(${CMAKE_BINARY_DIR}/CalxAbiConfigVersion.cmake VERSION ${CALX_ABI_VERSION}
                                 COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
configure_file(${CMAKE_CURRENT_LIST_DIR}/calx-abi.pc.in ${CMAKE_BINARY_DIR}/calx-abi.pc @ONLY)
install(DIRECTORY ${abi}/include/calx ${abi}/cpp/calx DESTINATION include COMPONENT abi)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/CalxAddPlugin.cmake ${CMAKE_CURRENT_LIST_DIR}/CalxAbiConfig.cmake
              ${CMAKE_BINARY_DIR}/CalxAbiConfigVersion.cmake
        DESTINATION lib/cmake/CalxAbi COMPONENT abi)
install(FILES ${CMAKE_BINARY_DIR}/calx-abi.pc DESTINATION lib/pkgconfig COMPONENT abi)
install(DIRECTORY ${abi}/template DESTINATION share/calx COMPONENT abi)
# The pages lie in one folder there, so links between folders of the tree are cut.
foreach(page abi/README.md abi/kinds.md abi/POLICY.md docs/case.md)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${abi}/../${page})
  file(READ ${abi}/../${page} text)
  string(REGEX REPLACE "\\]\\(\\.\\./(abi|docs)/" "](" text "${text}")
  get_filename_component(name ${page} NAME)
  file(WRITE ${CMAKE_BINARY_DIR}/share/doc/calx/${name} "${text}")
  install(FILES ${CMAKE_BINARY_DIR}/share/doc/calx/${name} DESTINATION share/doc/calx COMPONENT abi)
endforeach()
file(GLOB examples CONFIGURE_DEPENDS ${abi}/../examples/third_party_*)
install(DIRECTORY ${examples} DESTINATION share/calx/examples COMPONENT abi PATTERN "*.out" EXCLUDE PATTERN "build*" EXCLUDE)
# The plugins of Calx that the guide names as examples, as one project of a stranger; their pages stay in the tree.
set(folders)
foreach(name drag liquid_bridge servo_speed servo_stress effect_counterflow effect_load_cell_lag effect_rotor_leak)
  file(GLOB folder CONFIGURE_DEPENDS ${abi}/../plugins/${name}/CMakeLists.txt)
  if(folder)
    list(APPEND folders ${name})
    install(DIRECTORY ${abi}/../plugins/${name} DESTINATION share/calx/examples/plugins COMPONENT abi
            PATTERN README.md EXCLUDE PATTERN "build*" EXCLUDE)
  endif()
endforeach()
list(JOIN folders " " folders)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/share/calx/examples/plugins/CMakeLists.txt @ONLY CONTENT [[
# Plugins of Calx itself, built as anybody's: cmake -S . -B build -DCMAKE_PREFIX_PATH=<where Calx is installed>
cmake_minimum_required(VERSION 3.18)
project(calx-example-plugins LANGUAGES C CXX)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_package(CalxAbi 1.0 CONFIG REQUIRED)
foreach(folder @folders@)
  add_subdirectory(${folder})
endforeach()
]])
install(FILES ${CMAKE_BINARY_DIR}/share/calx/examples/plugins/CMakeLists.txt DESTINATION share/calx/examples/plugins COMPONENT abi)
file(GLOB_RECURSE templates CONFIGURE_DEPENDS ${abi}/template/*)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${templates})
file(COPY ${abi}/template DESTINATION ${CMAKE_BINARY_DIR}/share/calx)

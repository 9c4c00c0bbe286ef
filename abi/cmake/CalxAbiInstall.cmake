# Installs headers, find_package(CalxAbi), calx-abi.pc, the templates of calx plugin new, the guide of plugin authors and its
# examples; alone with cmake --install <build> --component abi. The templates lie beside the program of the build tree, too.
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
install(FILES ${abi}/README.md ${abi}/kinds.md DESTINATION share/doc/calx COMPONENT abi)
file(GLOB examples CONFIGURE_DEPENDS ${abi}/../examples/third_party_*)
install(DIRECTORY ${examples} DESTINATION share/calx/examples COMPONENT abi PATTERN "*.out" EXCLUDE PATTERN "build*" EXCLUDE)
file(GLOB_RECURSE templates CONFIGURE_DEPENDS ${abi}/template/*)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${templates})
file(COPY ${abi}/template DESTINATION ${CMAKE_BINARY_DIR}/share/calx)

# find_package(CalxAbi 1.0 CONFIG) gives Calx::abi (headers only) and calx_add_plugin().
include(${CMAKE_CURRENT_LIST_DIR}/CalxAddPlugin.cmake)

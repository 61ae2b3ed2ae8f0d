# The library for other programs: Sinew::sinew, libsinew, one file made of the rooms up to sim/,
# with the headers of include/sinew/. Types and functions of these headers are the whole interface.
# They include no header of another library, and the target does not propagate our warning flags.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/sinew/*.h)
add_library(sinew_library)
add_library(Sinew::sinew ALIAS sinew_library)
foreach(room base mesh io model forces contact solver identify scene sim capi)
  get_target_property(type sinew_${room} TYPE)
  if(NOT type STREQUAL "INTERFACE_LIBRARY")
    target_sources(sinew_library PRIVATE $<TARGET_OBJECTS:sinew_${room}>)
  endif()
endforeach()
target_sources(sinew_library PUBLIC FILE_SET HEADERS
  BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${headers})
target_compile_features(sinew_library INTERFACE cxx_std_20)
target_link_libraries(sinew_library PRIVATE Threads::Threads TBB::tbb fmt::fmt pugixml::pugixml
  ZLIB::ZLIB hwy::hwy tomlplusplus::tomlplusplus)
set_target_properties(sinew_library PROPERTIES OUTPUT_NAME sinew EXPORT_NAME sinew
  LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
if(BUILD_SHARED_LIBS AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  # Also hides instances of other libraries' templates, which their own headers make visible.
  set(map ${PROJECT_SOURCE_DIR}/cmake/sinew.map)
  target_link_options(sinew_library PRIVATE -Wl,--version-script=${map} -Wl,--no-undefined)
  set_property(TARGET sinew_library APPEND PROPERTY LINK_DEPENDS ${map})
endif()
if(SINEW_SANITIZE)
  target_link_libraries(sinew_library PRIVATE $<BUILD_INTERFACE:sinew_flags>)
endif()

if(NOT SINEW_INSTALL)
  return()
endif()
install(TARGETS sinew_library EXPORT SinewTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
          NAMELINK_COMPONENT development
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/Sinew)
install(EXPORT SinewTargets NAMESPACE Sinew:: DESTINATION ${folder} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/SinewConfig.cmake.in
  ${PROJECT_BINARY_DIR}/package/SinewConfig.cmake INSTALL_DESTINATION ${folder}
  NO_SET_AND_CHECK_MACRO)
# Until version 1 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/SinewConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/SinewConfig.cmake
  ${PROJECT_BINARY_DIR}/package/SinewConfigVersion.cmake
  DESTINATION ${folder} COMPONENT development)

# pkg-config. Programs that link the archive also link its libraries; the shared library brings
# them.
set(pc_requires "")
if(NOT BUILD_SHARED_LIBS)
  set(pc_requires "\nRequires: tbb fmt pugixml zlib libhwy tomlplusplus")
endif()
set(pc_folder ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_prefix ${pc_folder} ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH pc_include ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
file(RELATIVE_PATH pc_lib ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
configure_file(${PROJECT_SOURCE_DIR}/cmake/sinew.pc.in ${PROJECT_BINARY_DIR}/package/sinew.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/sinew.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT library)

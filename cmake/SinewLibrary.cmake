# The library for other programs: Sinew::sinew, libsinew, one file made of the rooms up to capi/,
# with the headers of include/sinew/. Types and functions of these headers are the whole interface.
# They include no header of another library, and the targets do not propagate our warning flags.
#
# Sinew's own build makes the archive and the shared library from the same objects, and installs
# both. A project that takes Sinew in gets one of them, as its BUILD_SHARED_LIBS says.
if(PROJECT_IS_TOP_LEVEL AND EXISTS /etc/debian_version AND NOT DEFINED CMAKE_INSTALL_LIBDIR)
  # Debian's folder, under any prefix: the same build is installed and packed.
  set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE} CACHE PATH "libraries")
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The number of the binary interface, libsinew.so.N: it rises when a program that was linked with
# the former library no longer runs with the new one (docs/releases.md). tests/install/abi.txt
# lists the symbols.
set(SINEW_ABI 0)

set(SINEW_LIBRARY_KINDS static)
if(BUILD_SHARED_LIBS)
  set(SINEW_LIBRARY_KINDS shared)
endif()
set(kind_of_sinew ${SINEW_LIBRARY_KINDS})
if(PROJECT_IS_TOP_LEVEL)
  set(SINEW_LIBRARY_KINDS static shared)
endif()

file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/sinew/*.h)
foreach(kind IN LISTS SINEW_LIBRARY_KINDS)
  set(library sinew_${kind})
  string(TOUPPER ${kind} type)
  add_library(${library} ${type})
  foreach(room base mesh io model forces contact cut solver identify scene sim haptics instruments capi)
    get_target_property(type sinew_${room} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      target_sources(${library} PRIVATE $<TARGET_OBJECTS:sinew_${room}>)
    endif()
  endforeach()
  target_sources(${library} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${headers})
  target_compile_features(${library} INTERFACE cxx_std_20)
  target_link_libraries(${library} PRIVATE Threads::Threads TBB::tbb fmt::fmt pugixml::pugixml
    ZLIB::ZLIB hwy::hwy tomlplusplus::tomlplusplus)
  set_target_properties(${library} PROPERTIES OUTPUT_NAME sinew EXPORT_NAME ${library}
    LINKER_LANGUAGE CXX VERSION ${SINEW_ABI}.${PROJECT_VERSION} SOVERSION ${SINEW_ABI})
  if(kind STREQUAL "shared" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    # Also hides instances of other libraries' templates, which their own headers make visible.
    set(map ${PROJECT_SOURCE_DIR}/cmake/sinew.map)
    target_link_options(${library} PRIVATE -Wl,--version-script=${map} -Wl,--no-undefined)
    set_property(TARGET ${library} APPEND PROPERTY LINK_DEPENDS ${map})
  endif()
  if(SINEW_SANITIZE)
    target_link_libraries(${library} PRIVATE $<BUILD_INTERFACE:sinew_flags>)
  endif()
endforeach()
add_library(Sinew::sinew ALIAS sinew_${kind_of_sinew})
add_custom_target(sinew_library)  # whichever kinds there are
foreach(kind IN LISTS SINEW_LIBRARY_KINDS)
  add_dependencies(sinew_library sinew_${kind})
endforeach()

if(NOT SINEW_INSTALL)
  return()
endif()
set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/Sinew)
foreach(kind IN LISTS SINEW_LIBRARY_KINDS)
  install(TARGETS sinew_${kind} EXPORT SinewTargets-${kind}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
            NAMELINK_COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  install(EXPORT SinewTargets-${kind} NAMESPACE Sinew:: DESTINATION ${folder}
    COMPONENT development)
endforeach()
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
set(pc_with_archive "")
if(NOT "shared" IN_LIST SINEW_LIBRARY_KINDS)
  set(pc_with_archive " -ltbb -lfmt -lpugixml -lz -lhwy -ltomlplusplus -pthread")
endif()
set(pc_folder ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_prefix ${pc_folder} ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH pc_include ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
file(RELATIVE_PATH pc_lib ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
configure_file(${PROJECT_SOURCE_DIR}/cmake/sinew.pc.in ${PROJECT_BINARY_DIR}/package/sinew.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/sinew.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

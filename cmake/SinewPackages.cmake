# Debian packages, by CPack: each component of the install rules is a package. `./dev package` makes
# them all and more: packaging/README.md.
find_program(SINEW_DPKG dpkg)
if(NOT SINEW_DPKG)
  return()
endif()

set(packaging ${PROJECT_SOURCE_DIR}/packaging)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sinew)
set(CPACK_PACKAGE_CONTACT "The Sinew developers <sinew@example.org>")
set(CPACK_PACKAGE_VENDOR "The Sinew developers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS  # whatever the umask of the build
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(exactly "(= ${PROJECT_VERSION}-1)")

# sinew_package(COMPONENT NAME SECTION SYNOPSIS TEXT [FIELD VALUE]...): its copyright and changelog
# lie where Debian expects them.
set(CPACK_COMPONENTS_ALL "")
function(sinew_package component name section synopsis text)
  string(TOUPPER ${component} upper)
  set(prefix CPACK_DEBIAN_${upper})
  set(${prefix}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(${prefix}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(${prefix}_DESCRIPTION "${synopsis}\n${text}" PARENT_SCOPE)
  while(ARGN)
    list(POP_FRONT ARGN field value)
    set(${prefix}_PACKAGE_${field} "${value}" PARENT_SCOPE)
  endwhile()
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DISPLAY_NAME ${name} PARENT_SCOPE)
  set(copyright ${packaging}/debian/copyright)
  if(EXISTS ${copyright}.${component})
    set(copyright ${copyright}.${component})
  endif()
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${name})
  install(FILES ${copyright} RENAME copyright DESTINATION ${doc} COMPONENT ${component})
  install(FILES ${PROJECT_BINARY_DIR}/package/changelog.Debian.gz DESTINATION ${doc}
    COMPONENT ${component} OPTIONAL)
  if(EXISTS ${packaging}/debian/${name}.lintian-overrides)
    install(FILES ${packaging}/debian/${name}.lintian-overrides RENAME ${name}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
  endif()
endfunction()

set(about "Sinew simulates soft tissue as a mass-spring system on tetrahedral meshes:
a mesh and a material in SI units go in; the motion, with its energy
balance, comes out.")
if(SINEW_APPS)
  sinew_package(program sinew science "simulator of soft tissue, command line and live view"
    "${about}\n\nThis package has the program 'sinew' with a live view in the browser,\nand scenes to begin with."
    RECOMMENDS python3-sinew SUGGESTS "sinew-mesh, paraview")
endif()
sinew_package(library libsinew${SINEW_ABI} libs "simulator of soft tissue, shared library"
  "${about}\n\nThis package has the shared library for C++20 and C99.")
set(control ${PROJECT_BINARY_DIR}/package/library)
file(WRITE ${control}/shlibs "libsinew ${SINEW_ABI} libsinew${SINEW_ABI} (>= ${PROJECT_VERSION})\n")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${control}/shlibs ${control}/triggers)
sinew_package(development libsinew-dev libdevel "simulator of soft tissue, files for development"
  "${about}\n\nThis package has the headers, the archive, and the files of CMake and\npkg-config. To link the archive, install the suggested packages too."
  DEPENDS "libsinew${SINEW_ABI} ${exactly}"
  SUGGESTS "libtbb-dev, libfmt-dev, libpugixml-dev, zlib1g-dev, libhwy-dev, libtomlplusplus-dev")
if(SINEW_PYTHON_PACKAGE)
  execute_process(COMMAND ${SINEW_PYTHON} -c "import sys; print(sys.version_info.minor)"
    OUTPUT_VARIABLE minor OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  math(EXPR next "${minor} + 1")
  sinew_package(python python3-sinew python "simulator of soft tissue, Python package"
    "${about}\n\nThis package has the Python package: scenes and simulations with numpy\narrays, parameter studies, calibration."
    DEPENDS "python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-numpy"
    RECOMMENDS "sinew ${exactly}, python3-matplotlib"
    SUGGESTS "python3-scipy, python3-distributed, python3-h5py, python3-pandas, python3-meshio")
endif()
if(TARGET sinew-mesh)
  sinew_package(mesher sinew-mesh science "tetrahedral meshes from surfaces and images"
    "sinew-mesh fills closed surfaces and labelled images with tetrahedra, by\nCGAL; Sinew and other simulators read the meshes.\n\nIt is under the GPL, unlike Sinew itself.")
endif()

# The changelog of the packages names the release; CHANGELOG.md lies beside it.
find_program(SINEW_GZIP gzip REQUIRED)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${PROJECT_BINARY_DIR}/package/changelog.Debian
  "sinew (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n  * Release ${PROJECT_VERSION}: see CHANGELOG.md.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
execute_process(COMMAND ${SINEW_GZIP} -9nf ${PROJECT_BINARY_DIR}/package/changelog.Debian)
include(CPack)

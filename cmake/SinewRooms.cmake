# One static library per room (docs/architecture.md), and their common flags.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(TBB REQUIRED)
find_package(pugixml REQUIRED)
find_package(ZLIB REQUIRED)
find_package(hwy REQUIRED)
find_path(SINEW_XXHASH_INCLUDE xxhash.h REQUIRED)  # compiled in: base/hash.cpp
find_package(tomlplusplus REQUIRED)

add_library(sinew_flags INTERFACE)
# The same scene gives the same bits: no implicit fused multiply-adds, no -march=native.
target_compile_options(sinew_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:SINEW_BATCH_SHADOWS>>>:-Wshadow> -ffp-contract=off
  $<$<BOOL:${SINEW_WERROR}>:-Werror>)
target_include_directories(sinew_flags INTERFACE
  ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
target_include_directories(sinew_flags SYSTEM INTERFACE ${SINEW_XXHASH_INCLUDE})
target_compile_definitions(sinew_flags INTERFACE EIGEN_MPL2_ONLY)
if(SINEW_SANITIZE)
  target_compile_options(sinew_flags INTERFACE
    -fsanitize=${SINEW_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(sinew_flags INTERFACE -fsanitize=${SINEW_SANITIZE})
  if(SINEW_SANITIZE MATCHES "address.*undefined")
    # The address sanitizer finds these at the access; checked twice, the build takes a third longer.
    target_compile_options(sinew_flags INTERFACE
      -fno-sanitize=null,object-size,pointer-overflow)
  endif()
endif()

# A plain build compiles the sources of a room in batches (unity builds) and precompiles the
# heaviest headers: most of the compiler's time goes into headers and their templates, once for each
# source. The preset debug uses neither, so that a missing include is detected.
option(SINEW_FAST_BUILD "Unity builds and precompiled headers" ON)
set(SINEW_BATCH 16 CACHE STRING "Sources in a batch of a unity build")
if(SINEW_FAST_BUILD AND CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache"
   AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-fpch-preprocess)  # ccache needs it to see through precompiled headers
endif()

# sinew_precompile(TARGET FIRST [headers...]): precompiles the heaviest headers, once for all
# targets with the same FIRST, whose flags they share.
function(sinew_precompile target first)
  if(NOT SINEW_FAST_BUILD)
    return()
  endif()
  if(target STREQUAL first)
    target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <algorithm>
      <fmt/format.h> <functional> <map> <string> <tbb/parallel_for.h> <vector> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${first})
  endif()
endfunction()

# sinew_batches(TARGET): compiles the sources of TARGET in batches.
function(sinew_batches target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SINEW_FAST_BUILD}
    UNITY_BUILD_BATCH_SIZE ${SINEW_BATCH})
  if(SINEW_FAST_BUILD AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # clang warns if a local name shadows a name in the unnamed namespace of another file of the
    # batch; g++ checks the same sources.
    set_target_properties(${target} PROPERTIES SINEW_BATCH_SHADOWS ON)
  endif()
endfunction()

# sinew_room(NAME LEVEL [libraries...]): library sinew_NAME from src/sinew/NAME/*.cpp, linked to
# every room of a lower level.
set_property(GLOBAL PROPERTY SINEW_ROOMS "")
function(sinew_room name level)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/sinew/${name}/*.cpp)
  get_property(rooms GLOBAL PROPERTY SINEW_ROOMS)
  set(below "")
  foreach(room IN LISTS rooms)
    string(REPLACE ":" ";" pair ${room})
    list(GET pair 0 other)
    list(GET pair 1 other_level)
    if(other_level LESS level)
      list(APPEND below sinew_${other})
    endif()
  endforeach()
  if(sources)
    add_library(sinew_${name} STATIC ${sources})
    target_link_libraries(sinew_${name} PUBLIC sinew_flags ${below} ${ARGN})
    sinew_precompile(sinew_${name} sinew_base)
    sinew_batches(sinew_${name})
    # For libsinew and the Python module, which export only symbols marked SINEW_API. Always: the
    # program is as fast with it, and needs no other build.
    set_target_properties(sinew_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON
      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  else()
    add_library(sinew_${name} INTERFACE)
    target_link_libraries(sinew_${name} INTERFACE sinew_flags ${below} ${ARGN})
  endif()
  set_property(GLOBAL APPEND PROPERTY SINEW_ROOMS ${name}:${level})
endfunction()

# sinew_embed(ROOM FILE SYMBOL): embeds the text of FILE as `extern const char sinew::SYMBOL[]` in
# the library of ROOM, so that the binary needs no data file.
function(sinew_embed room file symbol)
  set(path ${PROJECT_SOURCE_DIR}/${file})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  file(READ ${path} text)
  set(source ${PROJECT_BINARY_DIR}/embedded/${symbol}.cpp)
  string(CONCAT code "// Generated from ${file}.\n"
    "#pragma GCC diagnostic ignored \"-Woverlength-strings\"\nnamespace sinew {\n"
    "extern const char ${symbol}[];\n"
    "const char ${symbol}[] = R\"embedded(${text})embedded\";\n}  // namespace sinew\n")
  file(CONFIGURE OUTPUT ${source} CONTENT "@code@" @ONLY)
  target_sources(sinew_${room} PRIVATE ${source})
endfunction()

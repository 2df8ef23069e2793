# The library's dependencies: targets partwheel_cgal (the headers of CGAL, Boost and Eigen) and partwheel_tetgen.
# Searches PARTWHEEL_DEPS first, where scripts/setup.sh puts them, then the system.

set(fix "Run scripts/build, which installs what is missing.")

# find_headers(VARIABLE NAME HEADER): sets VARIABLE to the include directory that has HEADER.
function(find_headers variable name header)
  find_path(${variable} ${header} PATHS "${PARTWHEEL_DEPS}/root/usr/include" PATH_SUFFIXES eigen3 NO_DEFAULT_PATH)
  find_path(${variable} ${header} PATH_SUFFIXES eigen3)
  if(NOT ${variable})
    message(FATAL_ERROR "${name} was not found: no ${header} under ${PARTWHEEL_DEPS}/root/usr/include, nor installed. "
                        "${fix}")
  endif()
endfunction()

# require_version(NAME FOUND MINIMUM WHERE): stops the configuration if version FOUND is missing or too old.
function(require_version name found minimum where)
  if(NOT found OR found VERSION_LESS minimum)
    message(FATAL_ERROR "${name} ${found} in ${where} is too old: ${minimum} or newer is needed. ${fix}")
  endif()
  message(STATUS "${name} ${found} in ${where}")
endfunction()

find_headers(CGAL_INCLUDE CGAL CGAL/version.h)
find_headers(BOOST_INCLUDE Boost boost/version.hpp)
find_headers(EIGEN_INCLUDE Eigen Eigen/Core)

file(STRINGS "${CGAL_INCLUDE}/CGAL/version.h" line REGEX "^#define CGAL_VERSION [0-9]")
string(REGEX MATCH "[0-9]+(\\.[0-9]+)+" found "${line}")
require_version(CGAL "${found}" 5.5 "${CGAL_INCLUDE}")

file(STRINGS "${BOOST_INCLUDE}/boost/version.hpp" line REGEX "^#define BOOST_LIB_VERSION ")
string(REGEX MATCH "[0-9]+_[0-9]+" found "${line}")
string(REPLACE "_" "." found "${found}")
# With an older Boost and no GMP, CGAL falls back to slow number types.
require_version(Boost "${found}" 1.81 "${BOOST_INCLUDE}")

file(STRINGS "${EIGEN_INCLUDE}/Eigen/src/Core/util/Macros.h" lines REGEX "^#define EIGEN_[A-Z]+_VERSION [0-9]+")
string(REGEX MATCHALL "[0-9]+" found "${lines}")
list(JOIN found "." found)
require_version(Eigen "${found}" 3.4 "${EIGEN_INCLUDE}")

set(deterministic_cgal "${PROJECT_SOURCE_DIR}/build/cgal")
include(cmake/deterministic_cgal.cmake)

add_library(partwheel_cgal INTERFACE)
target_include_directories(partwheel_cgal SYSTEM INTERFACE "${deterministic_cgal}" "${PROJECT_SOURCE_DIR}/cmake/cgal"
                                                           "${CGAL_INCLUDE}" "${BOOST_INCLUDE}" "${EIGEN_INCLUDE}")
# Without GMP and MPFR the package needs no other libraries, and results are the same on every machine.
# CGAL's own checks stay on in a release, so broken meshes cause an exception, not a crash.
target_compile_definitions(partwheel_cgal INTERFACE CGAL_DISABLE_GMP=1 CGAL_DISABLE_MPFR=1 CGAL_DEBUG=1
                                                   CGAL_NO_WARNINGS=1)
# Neither ninja nor ccache notices that a new header hides another one.
string(SHA256 digest "${changed}")
target_compile_definitions(partwheel_cgal INTERFACE PARTWHEEL_CGAL_CHANGES=${digest})
if(APPLE)  # there, no list of exported symbols is passed to the linker
  target_compile_definitions(partwheel_cgal INTERFACE BOOST_DISABLE_EXPLICIT_SYMBOL_VISIBILITY)
endif()

set(tetgen_include "${PARTWHEEL_TETGEN_SOURCE}")
if(NOT EXISTS "${tetgen_include}/tetgen.cxx")
  message(FATAL_ERROR "TetGen was not found: no ${tetgen_include}/tetgen.cxx. ${fix}")
endif()
include(cmake/patched_tetgen.cmake)
file(CONFIGURE OUTPUT patched_tetgen.cxx CONTENT "${tetgen_source}" @ONLY)
file(CONFIGURE OUTPUT patched_predicates.cxx CONTENT "${predicates_source}" @ONLY)
set(tetgen "${CMAKE_CURRENT_BINARY_DIR}/patched_tetgen.cxx")
set(predicates "${CMAKE_CURRENT_BINARY_DIR}/patched_predicates.cxx")
add_library(partwheel_tetgen STATIC "${tetgen}" "${predicates}")
target_include_directories(partwheel_tetgen PRIVATE "${tetgen_include}")
target_compile_options(partwheel_tetgen PRIVATE -w)
if(PARTWHEEL_SANITIZE MATCHES undefined)  # TetGen's memory pools keep pointers at unaligned addresses
  target_compile_options(partwheel_tetgen PRIVATE -fno-sanitize=undefined)
endif()
if(PARTWHEEL_SANITIZE MATCHES address)  # TetGen's predicates read one element past an array's end, and ignore it
  set_source_files_properties("${predicates}" PROPERTIES COMPILE_OPTIONS -fno-sanitize=address)
endif()
target_compile_definitions(partwheel_tetgen PUBLIC TETLIBRARY PRIVATE NDEBUG PARTWHEEL_COMPILES_TETGEN)
# Only in this file: the other one defines orient3d.
set_source_files_properties("${tetgen}" PROPERTIES COMPILE_DEFINITIONS orient3d=partwheel_tetgen_orient3d)
target_compile_options(partwheel_tetgen PRIVATE "SHELL:-include \"${PROJECT_SOURCE_DIR}/native/src/fill/tetgen_host.h\"")
file(STRINGS "${tetgen_include}/tetgen.h" line REGEX "^// Version [0-9]")
string(REGEX MATCH "[0-9]+(\\.[0-9]+)+" found "${line}")
# Earlier versions free memory twice when they refuse an input.
require_version(TetGen "${found}" 1.6 "${tetgen_include}")
target_include_directories(partwheel_tetgen SYSTEM INTERFACE "${tetgen_include}")

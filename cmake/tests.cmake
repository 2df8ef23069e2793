# The native tests: each tests/native/*_test.cpp is a program of its own, linked with support/*.cpp.
# They see the engine's rooms and the shared library's C API; PARTWHEEL_MESHES is the directory of the real models.

if(PARTWHEEL_PLATFORM)  # for which it is not compiled yet; Debian's has its sources here
  set(BUILD_SHARED_LIBS OFF)
  add_subdirectory(/usr/src/googletest/googletest googletest EXCLUDE_FROM_ALL)
else()
  find_package(GTest)
  if(NOT GTest_FOUND)
    message(FATAL_ERROR "GoogleTest was not found. ${fix} Or configure with -DPARTWHEEL_TESTS=OFF.")
  endif()
endif()
include(GoogleTest)

file(GLOB programs CONFIGURE_DEPENDS tests/native/*_test.cpp)
if(PARTWHEEL_PLATFORM)
  list(FILTER programs EXCLUDE REGEX "/work_test\\.cpp$")  # needs a linker that sends calls elsewhere
endif()
file(GLOB sources CONFIGURE_DEPENDS tests/native/support/*.cpp)

add_library(partwheel_test_support INTERFACE)
target_include_directories(partwheel_test_support INTERFACE tests/native)
target_link_libraries(partwheel_test_support INTERFACE partwheel_engine partwheel GTest::gtest GTest::gtest_main)
target_compile_definitions(partwheel_test_support INTERFACE PARTWHEEL_MESHES="${PARTWHEEL_MESHES}")
if(sources)
  add_library(partwheel_test_sources STATIC ${sources})
  target_link_libraries(partwheel_test_sources PUBLIC partwheel_test_support)
  if(PARTWHEEL_PLATFORM MATCHES "^linux")  # the engine's rooms, which tests see beside the library, want it too
    target_sources(partwheel_test_sources PRIVATE cmake/cross/single_threaded.cpp)
  endif()
endif()

foreach(source ${programs})
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} "${source}")
  target_link_libraries(${name} PRIVATE $<TARGET_NAME_IF_EXISTS:partwheel_test_sources> partwheel_test_support)
  if(PARTWHEEL_PLATFORM)  # whole: to start wine takes longer than most tests
    add_test(NAME ${name} COMMAND ${name})
  else()
    gtest_discover_tests(${name} TEST_PREFIX "${name}:" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                         PROPERTIES TIMEOUT 600)
  endif()
endforeach()

if(PARTWHEEL_PLATFORM)
  return()  # the rest is asked once, and of shipped libraries by scripts/package_parts/checks.py
endif()

# It counts what the engine's rooms call: the linker sends these calls to the test, also those of its own pw_build().
target_sources(work_test PRIVATE native/src/api.cpp)
target_link_options(work_test PRIVATE LINKER:--wrap=_ZN9partwheel8Progress7advanceEd
                                      LINKER:--wrap=_Z14tetrahedralizeP14tetgenbehaviorP8tetgenioS2_S2_S2_)
target_link_libraries(work_test PRIVATE partwheel_tetgen)

add_test(NAME exports COMMAND "${CMAKE_COMMAND}" -DNM=${CMAKE_NM} -DLIBRARY=$<TARGET_FILE:partwheel>
                              -DHEADERS=${PROJECT_SOURCE_DIR}/native/include
                              -P "${PROJECT_SOURCE_DIR}/cmake/check_exports.cmake")

# What tests/core asks CGAL, through ctypes.
add_library(partwheel_checks MODULE tests/core/self_intersections.cpp)
target_link_libraries(partwheel_checks PRIVATE partwheel_cgal)
set_target_properties(partwheel_checks PROPERTIES POSITION_INDEPENDENT_CODE ON)

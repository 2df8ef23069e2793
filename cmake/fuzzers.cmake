# The fuzzers: each tests/fuzz/*_fuzzer.cpp is a program of libFuzzer's, which scripts/test fuzz runs.

find_package(GTest)
if(NOT GTest_FOUND)
  message(FATAL_ERROR "GoogleTest was not found. ${fix} Or configure with -DPARTWHEEL_FUZZERS=OFF.")
endif()
if(NOT PARTWHEEL_TESTS)
  message(FATAL_ERROR "The fuzzers share sources with the native tests: configure with -DPARTWHEEL_TESTS=ON.")
endif()
if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
  message(FATAL_ERROR "The fuzzers need clang: cmake --preset asan")
endif()

# What reads the bytes is compiled once more, for the fuzzers alone, and found before the engine's own: it tells what it
# compares them with, and a saved hierarchy's hash is not compared, so that a fuzzer gets behind it.
add_library(partwheel_fuzzed OBJECT ${PARTWHEEL_API} native/src/tree/packed.cpp native/src/tree/saved.cpp)
target_compile_options(partwheel_fuzzed PRIVATE -fsanitize-coverage=trace-cmp)
target_compile_definitions(partwheel_fuzzed PRIVATE PW_BUILDING FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION)
target_include_directories(partwheel_fuzzed PUBLIC tests/native)
target_link_libraries(partwheel_fuzzed PUBLIC partwheel_engine GTest::gtest)

file(GLOB programs CONFIGURE_DEPENDS tests/fuzz/*_fuzzer.cpp)
foreach(source ${programs})
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} "${source}"
                         $<FILTER:$<TARGET_OBJECTS:partwheel_engine>,EXCLUDE,/packed\\.cpp|/saved\\.cpp> $<TARGET_OBJECTS:partwheel_fallback>
                         $<TARGET_OBJECTS:partwheel_test_sources>)
  target_link_libraries(${name} PRIVATE partwheel_fuzzed)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
endforeach()

# The benchmarks: each tests/bench/*_bench.cpp is a program of its own.

find_package(benchmark)
if(NOT benchmark_FOUND)
  message(FATAL_ERROR "Google Benchmark was not found. ${fix} Or configure with -DPARTWHEEL_BENCHMARKS=OFF.")
endif()

file(GLOB programs CONFIGURE_DEPENDS tests/bench/*_bench.cpp)
foreach(source ${programs})
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} "${source}")
  target_compile_definitions(${name} PRIVATE PARTWHEEL_MESHES="${PARTWHEEL_MESHES}")
  target_link_libraries(${name} PRIVATE partwheel_engine benchmark::benchmark benchmark::benchmark_main)
endforeach()

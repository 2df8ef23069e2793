# The benchmarks: each tests/bench/*_bench.cpp is a program of its own, which scripts/bench runs. Nothing builds them but their
# target.

add_library(partwheel_measured OBJECT EXCLUDE_FROM_ALL tests/bench/measured.cpp tests/bench/tetgen_watch.cpp ${PARTWHEEL_API})
target_compile_definitions(partwheel_measured PRIVATE PW_BUILDING)
target_include_directories(partwheel_measured PUBLIC tests/native)
target_link_libraries(partwheel_measured PUBLIC partwheel_engine PRIVATE partwheel_tetgen)
# The library's call of TetGen goes through tetgen_watch.cpp, which measures it.
target_link_options(partwheel_measured INTERFACE LINKER:--wrap=_Z14tetrahedralizeP14tetgenbehaviorP8tetgenioS2_S2_S2_)

file(GLOB programs CONFIGURE_DEPENDS tests/bench/*_bench.cpp)
foreach(source ${programs})
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} EXCLUDE_FROM_ALL "${source}")
  target_link_libraries(${name} PRIVATE partwheel_measured)
  list(APPEND benchmarks ${name})
endforeach()

# What tests/quality/fit.py runs.
add_executable(quality_trace EXCLUDE_FROM_ALL tests/quality/trace.cpp)
target_link_libraries(quality_trace PRIVATE partwheel_engine)

add_custom_target(benchmarks DEPENDS ${benchmarks} quality_trace)

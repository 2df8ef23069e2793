# The benchmarks: each tests/bench/*_bench.cpp is a program of its own, which scripts/bench runs.

add_library(partwheel_measured OBJECT tests/bench/measured.cpp tests/bench/tetgen_watch.cpp ${PARTWHEEL_API})
target_compile_definitions(partwheel_measured PRIVATE PW_BUILDING)
target_link_libraries(partwheel_measured PUBLIC partwheel_engine PRIVATE partwheel_tetgen)
# The library's call of TetGen goes through tetgen_watch.cpp, which measures it.
target_link_options(partwheel_measured INTERFACE LINKER:--wrap=_Z14tetrahedralizeP14tetgenbehaviorP8tetgenioS2_S2_S2_)

file(GLOB programs CONFIGURE_DEPENDS tests/bench/*_bench.cpp)
foreach(source ${programs})
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} "${source}")
  target_link_libraries(${name} PRIVATE partwheel_measured)
endforeach()

# What tests/quality/fit.py runs.
add_executable(quality_trace tests/quality/trace.cpp)
target_link_libraries(quality_trace PRIVATE partwheel_engine)

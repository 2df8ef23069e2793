# Reads tetgen.cxx from ${tetgen_include} into tetgen_source, patched and checked. Also a script, for tests:
# cmake -Dtetgen_include=... -P patched_tetgen.cmake

cmake_minimum_required(VERSION 3.25)

# Makes TetGen call partwheel_tetgen_poll(), which checks for cancellation, wherever it fills, empties or traverses its pools
# and arrays. Without these calls, whole passes could not be interrupted.
file(READ "${tetgen_include}/tetgen.cxx" tetgen_source)
foreach(head "memorypool::alloc()" "memorypool::dealloc(void *dyingitem)" "memorypool::traverse()"
             "arraypool::newindex(void **newptr)")
  string(REPLACE "${head}\n{\n" "${head}\n{\n  partwheel_tetgen_poll();\n" polled "${tetgen_source}")
  if(polled STREQUAL tetgen_source)
    message(FATAL_ERROR "This TetGen has no ${head}, so a cancellation could not interrupt it. ${fix}")
  endif()
  set(tetgen_source "${polled}")
endforeach()

# tetgen_host.h replaces functions by macros. It must replace all functions that TetGen calls and whose last bits differ
# between systems, except pow: TetGen calls it only for volume limits, and we set none.
file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/../native/src/fill/tetgen_host.h" replaced REGEX "^#define [a-z0-9]+ partwheel_tetgen_")
list(TRANSFORM replaced REPLACE "^#define ([a-z0-9]+) .*" "\\1")
foreach(name acos asin atan atan2 cbrt cos cosh exp exp2 hypot log log10 log2 sin sinh tan tanh ${replaced})
  string(REGEX MATCH "[^a-zA-Z_0-9]${name} *[(]" call "${tetgen_source}")
  if(call AND NOT name IN_LIST replaced)
    message(FATAL_ERROR "This TetGen calls ${name}: results would depend on the system. Replace it in "
                        "native/src/fill/tetgen_host.h, or use the pinned TetGen. ${fix}")
  elseif(NOT call AND name IN_LIST replaced)
    message(FATAL_ERROR "This TetGen does not call ${name}, which native/src/fill/tetgen_host.h replaces. ${fix}")
  endif()
endforeach()

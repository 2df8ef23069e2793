# Reads tetgen.cxx and predicates.cxx from ${tetgen_include} into tetgen_source and predicates_source, patched and checked.
# Also a script, for tests: cmake -Dtetgen_include=... -P patched_tetgen.cmake

cmake_minimum_required(VERSION 3.25)

file(READ "${tetgen_include}/tetgen.cxx" tetgen_source)
file(READ "${tetgen_include}/predicates.cxx" predicates_source)

# Replaces ${pattern}, a regular expression, in the variable ${source}, or fails: without it, ${consequence}.
function(patch source pattern replacement consequence)
  string(REGEX REPLACE "${pattern}" "${replacement}" patched "${${source}}")
  if(patched STREQUAL "${${source}}")
    message(FATAL_ERROR "This TetGen has no ${pattern}, so ${consequence}. ${fix}")
  endif()
  set(${source} "${patched}" PARENT_SCOPE)
endfunction()

# Makes TetGen call partwheel_tetgen_poll(), which checks for cancellation, wherever it fills, empties or traverses its pools
# and arrays. Without these calls, whole passes could not be interrupted.
foreach(head "memorypool::alloc[(][)]" "memorypool::dealloc[(]void [*]dyingitem[)]" "memorypool::traverse[(][)]"
             "arraypool::newindex[(]void [*][*]newptr[)]")
  patch(tetgen_source "(${head}\n{\n)" "\\1  partwheel_tetgen_poll();\n" "a cancellation could not interrupt it")
endforeach()

# Shells are filled in several threads, so TetGen must not write global state: its tables are initialized once, the bounds of
# its predicates belong to the thread, and what it prints goes nowhere.
set(consequence "it could not run in several threads")
patch(tetgen_source "\n  inittables[(][)];" "\n  static const bool has_tables = (inittables(), true);\n  (void)has_tables;" "${consequence}")
patch(tetgen_source "std::cerr" "partwheel_tetgen_cerr" "${consequence}")
patch(predicates_source "\nstatic (REAL|int) ([a-zA-Z0-9_, ]+);" "\nstatic thread_local \\1 \\2;" "${consequence}")

# Makes it look for the facets at an edge among those of the end that has fewer: a fan's facets all meet at one end. Both have
# them in the same order.
set(consequence "the time for a fan would be quadratic")
patch(tetgen_source "(    idx = pointmark[(]torg[)] - in->firstnumber;\n)(    // Loop through the set of subfaces containing 'torg')"
      "\\1    m = pointmark(tdest) - in->firstnumber;
    const bool from_tdest = idx2faclist[m + 1] - idx2faclist[m] < idx2faclist[idx + 1] - idx2faclist[idx];
    if (from_tdest) idx = m;
\\2" "${consequence}")
patch(tetgen_source "(      // Search the edge torg->tdest[.]\n)"
      "\\1      partwheel_tetgen_poll();
      if (from_tdest) {
        if (sdest(sface) != torg) senext2self(sface);
        if (sdest(sface) == torg) sesymself(sface);
        if (sorg(sface) != torg) continue;
      }
" "${consequence}")

# Makes it leave flat tetrahedra as they are where removing them takes too long: it flips edges to be able to flip others.
set(consequence "improving might not end")
patch(tetgen_source "(void tetgenmesh::improve_mesh[(][)]\n{\n)" "\\1  partwheel_tetgen_begin_improving();\n" "${consequence}")
patch(tetgen_source "if [(](repair_tet[(])" "if (!partwheel_tetgen_must_end_improving() \&\& \\1" "${consequence}")
patch(tetgen_source "[(]level < b->fliplinklevel[)]" "\\0 \&\& !partwheel_tetgen_must_end_improving()" "${consequence}")

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

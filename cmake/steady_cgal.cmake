# CGAL's headers, changed where its results would depend on the standard library or the system: cmake/cgal says how.
# From ${CGAL_INCLUDE} to ${steady_cgal}. Also a script, for tests: cmake -DCGAL_INCLUDE=... -Dsteady_cgal=... -P steady_cgal.cmake

cmake_minimum_required(VERSION 3.25)

# Of triangles that close a hole equally well the one that comes first is taken, which is a matter of addresses.
set(first_of_best "if(m_min == -1 || w < w_min){")
set(lowest_of_best "if(m_min == -1 || w < w_min || (!(w_min < w) && v2 < m_min)){")

# The changes that must take effect, at least in these headers: text of the changed header @ header. All others that we
# include come through them or are like them.
set(expected
    "partwheel::steady::nth_element@Hilbert_sort_base.h"
    "partwheel::steady::nth_element@AABB_traits.h"
    "partwheel::steady::nth_element@Polygon_mesh_processing/internal/Corefinement/face_graph_utils.h"
    "partwheel::steady::atan2@Kernel/function_objects.h"
    "partwheel::steady::acos@Weights/internal/utils.h"
    "boost::unordered_map@Polygon_mesh_processing/stitch_borders.h"
    "boost::unordered_set@Polygon_mesh_processing/border.h"
    "boost::unordered_map@Polygon_mesh_processing/repair_self_intersections.h"
    "boost::unordered_map@Polygon_mesh_processing/internal/Corefinement/Visitor.h"
    "boost::unordered_set@Polygon_mesh_processing/internal/Corefinement/Face_graph_output_builder.h"
    "${lowest_of_best}@Polygon_mesh_processing/internal/Hole_filling/Triangulate_hole_polyline.h")

set(changed)
file(GLOB_RECURSE headers RELATIVE "${CGAL_INCLUDE}" "${CGAL_INCLUDE}/CGAL/*.h")
foreach(header IN LISTS headers)
  file(READ "${CGAL_INCLUDE}/${header}" text)
  string(REGEX REPLACE "std::unordered_(map|set)" "boost::unordered_\\1" steady "${text}")
  string(REGEX REPLACE "std::(nth_element|atan2|acos)" "partwheel::steady::\\1" steady "${steady}")
  string(REPLACE "${first_of_best}" "${lowest_of_best}" steady "${steady}")
  if(NOT steady STREQUAL text)
    file(CONFIGURE OUTPUT "${steady_cgal}/${header}" CONTENT "#include <partwheel/steady.h>\n${steady}" @ONLY)
    list(APPEND changed "${header}")
  endif()
endforeach()

# Those of another CGAL, before this one was there, would hide its own.
file(GLOB_RECURSE present RELATIVE "${steady_cgal}" "${steady_cgal}/CGAL/*.h")
foreach(header IN LISTS present)
  if(NOT header IN_LIST changed)
    file(REMOVE "${steady_cgal}/${header}")
  endif()
endforeach()

foreach(each IN LISTS expected)
  string(REGEX MATCH "^(.*)@(.*)$" each "${each}")
  set(wanted "${CMAKE_MATCH_1}")
  set(header "CGAL/${CMAKE_MATCH_2}")
  set(text "")
  if(EXISTS "${steady_cgal}/${header}")
    file(READ "${steady_cgal}/${header}" text)
  endif()
  string(FIND "${text}" "${wanted}" place)
  if(place LESS 0)
    message(FATAL_ERROR "This CGAL's ${header} has no place for ${wanted}: results would depend on the system. Use CGAL 5.5 "
                        "(scripts/build installs it), or find what this one has instead, and adapt cmake/steady_cgal.cmake.")
  endif()
endforeach()

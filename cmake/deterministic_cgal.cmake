# Copies CGAL's headers from ${CGAL_INCLUDE} to ${deterministic_cgal}, those that it must change so that results don't
# depend on the standard library or the system, a union ends, and less is done in vain. cmake/cgal explains the changes. Also
# runs as a script, for tests:
# cmake -DCGAL_INCLUDE=... -Ddeterministic_cgal=... -P deterministic_cgal.cmake

cmake_minimum_required(VERSION 3.25)

# Among triangles that close a hole equally well CGAL takes the first, which depends on memory addresses.
set(first_of_best "if(m_min == -1 || w < w_min){")
set(lowest_of_best "if(m_min == -1 || w < w_min || (!(w_min < w) && v2 < m_min)){")

# CGAL 5.5 doesn't look at edges of a union whose patches are classified already. So it builds unions that are not manifold
# there, which never ends, or crashes. CGAL 5.6 looks at all edges.
set(skipped_edge "continue; // all patches were already classified, no need to redo it")
set(checked_edge "{}  // the union may not be manifold here")

# CGAL looks for crossings once more after it has removed them, for a result that we do not use.
set(last_check "bool self_intersects = does_self_intersect(working_face_range, tmesh, parameters::vertex_point_map(vpm).geom_traits(gt))")
set(no_check "const bool self_intersects = false")

# To remove crossings, CGAL smooths the surface around them first. What a hundred passes remove, ten remove, too.
set(many_passes ".number_of_iterations(100)")
set(few_passes ".number_of_iterations(10)")

# A vertex's normal needs those of a few faces: a hash table with nodes takes longer than the normals.
set(hashed_normals "std::unordered_map<face_descriptor, Vector_3>")
set(flat_normals "boost::unordered_flat_map<face_descriptor, Vector_3>")

# Changes that must take effect, as TEXT@HEADER: the changed header must contain the text. Other headers that we include
# change in the same way.
set(expected
    "partwheel::deterministic::nth_element@Hilbert_sort_base.h"
    "partwheel::deterministic::nth_element@AABB_traits.h"
    "partwheel::deterministic::nth_element@Polygon_mesh_processing/internal/Corefinement/face_graph_utils.h"
    "partwheel::deterministic::atan2@Kernel/function_objects.h"
    "partwheel::deterministic::acos@Weights/internal/utils.h"
    "boost::unordered_map@Polygon_mesh_processing/stitch_borders.h"
    "boost::unordered_set@Polygon_mesh_processing/border.h"
    "boost::unordered_map@Polygon_mesh_processing/repair_self_intersections.h"
    "boost::unordered_map@Polygon_mesh_processing/internal/Corefinement/Visitor.h"
    "boost::unordered_set@Polygon_mesh_processing/internal/Corefinement/Face_graph_output_builder.h"
    "${flat_normals}@Polygon_mesh_processing/compute_normal.h"
    "${few_passes}@Polygon_mesh_processing/repair_self_intersections.h"
    "${no_check}@Polygon_mesh_processing/repair_self_intersections.h"
    "${checked_edge}@Polygon_mesh_processing/internal/Corefinement/Face_graph_output_builder.h"
    "${lowest_of_best}@Polygon_mesh_processing/internal/Hole_filling/Triangulate_hole_polyline.h")

set(changed)
file(GLOB_RECURSE headers RELATIVE "${CGAL_INCLUDE}" "${CGAL_INCLUDE}/CGAL/*.h")
foreach(header IN LISTS headers)
  file(READ "${CGAL_INCLUDE}/${header}" text)
  string(REPLACE "${hashed_normals}" "${flat_normals}" new_text "${text}")
  string(REGEX REPLACE "std::unordered_(map|set)" "boost::unordered_\\1" new_text "${new_text}")
  string(REGEX REPLACE "std::(nth_element|atan2|acos)" "partwheel::deterministic::\\1" new_text "${new_text}")
  string(REPLACE "${first_of_best}" "${lowest_of_best}" new_text "${new_text}")
  string(REPLACE "${skipped_edge}" "${checked_edge}" new_text "${new_text}")
  string(REPLACE "${many_passes}" "${few_passes}" new_text "${new_text}")
  string(REPLACE "${last_check}" "${no_check}" new_text "${new_text}")
  if(NOT new_text STREQUAL text)
    file(CONFIGURE OUTPUT "${deterministic_cgal}/${header}" CONTENT "#include <partwheel/deterministic.h>\n${new_text}" @ONLY)
    list(APPEND changed "${header}")
  endif()
endforeach()

# Headers that remain from another version of CGAL would hide those of this one.
file(GLOB_RECURSE present RELATIVE "${deterministic_cgal}" "${deterministic_cgal}/CGAL/*.h")
foreach(header IN LISTS present)
  if(NOT header IN_LIST changed)
    file(REMOVE "${deterministic_cgal}/${header}")
  endif()
endforeach()

foreach(change IN LISTS expected)
  string(REGEX MATCH "^(.*)@(.*)$" change "${change}")
  set(changed_text "${CMAKE_MATCH_1}")
  set(header "CGAL/${CMAKE_MATCH_2}")
  set(text "")
  if(EXISTS "${deterministic_cgal}/${header}")
    file(READ "${deterministic_cgal}/${header}" text)
  endif()
  string(FIND "${text}" "${changed_text}" position)
  if(position LESS 0)
    message(FATAL_ERROR "This CGAL's ${header} can't be changed to ${changed_text}, so results would depend on the system, "
                        "or a union would never end. Use CGAL 5.5 (scripts/build installs it), or adapt cmake/deterministic_cgal.cmake to this version.")
  endif()
endforeach()

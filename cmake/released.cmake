# What a sanitizer is not to watch is compiled once, for the release: its objects are linked here as well, from build/release,
# which scripts/build builds before. Put behind the engine's on the linker's line: of an inline function that both have, the
# first is taken, and is to be the one that is watched.

set(PARTWHEEL_RELEASE "${PROJECT_SOURCE_DIR}/build/release" CACHE PATH "A release build, for a sanitizer's: with its tests")

# released(VARIABLE TARGET SOURCE...): the objects that the release's TARGET of this directory has for these sources.
function(released variable target)
  file(RELATIVE_PATH room "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  set(objects)
  foreach(source ${ARGN})
    file(RELATIVE_PATH path "${CMAKE_CURRENT_SOURCE_DIR}" "${source}")
    string(REPLACE "../" "__/" path "${path}")
    list(APPEND objects "${PARTWHEEL_RELEASE}/${room}/CMakeFiles/${target}.dir/${path}.o")
  endforeach()
  set_source_files_properties(${objects} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)  # not there yet, maybe
  set(${variable} "${objects}" PARENT_SCOPE)
endfunction()

# released_library(TARGET SOURCE...): the same as an object library of that name.
function(released_library target)
  released(objects ${target} ${ARGN})
  add_library(${target} OBJECT IMPORTED GLOBAL)
  set_target_properties(${target} PROPERTIES IMPORTED_OBJECTS "${objects}")
endfunction()

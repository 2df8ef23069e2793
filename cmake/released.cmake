# Code that a sanitizer need not check is not compiled again: a sanitizer's build links its objects from build/release, which
# scripts/build builds first. On the linker's command line they must follow the instrumented objects: the linker keeps the
# first copy of an inline function, and that must be the instrumented one.

set(PARTWHEEL_RELEASE "${PROJECT_SOURCE_DIR}/build/release" CACHE PATH "The release build, with tests, whose objects a sanitizer's build links")

# released(VARIABLE TARGET SOURCE...): the release's objects of these sources, in TARGET of this directory.
function(released variable target)
  file(RELATIVE_PATH directory "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  set(objects)
  foreach(source ${ARGN})
    file(RELATIVE_PATH path "${CMAKE_CURRENT_SOURCE_DIR}" "${source}")
    string(REPLACE "../" "__/" path "${path}")
    list(APPEND objects "${PARTWHEEL_RELEASE}/${directory}/CMakeFiles/${target}.dir/${path}.o")
  endforeach()
  set_source_files_properties(${objects} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)  # they may not exist yet
  set(${variable} "${objects}" PARENT_SCOPE)
endfunction()

# released_library(TARGET SOURCE...): an object library TARGET of these objects.
function(released_library target)
  released(objects ${target} ${ARGN})
  add_library(${target} OBJECT IMPORTED GLOBAL)
  set_target_properties(${target} PROPERTIES IMPORTED_OBJECTS "${objects}")
endfunction()

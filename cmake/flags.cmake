# How our own code is compiled: target partwheel_flags; and what holds for third-party sources too.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

find_package(Threads REQUIRED)

# No fused multiply-adds: they break exact predicates, and results are to be the same on every machine.
add_compile_options(-ffp-contract=off -ffunction-sections -fdata-sections)
if(APPLE)
  add_link_options(LINKER:-dead_strip)
else()
  add_link_options(LINKER:--gc-sections)
endif()
# Messages name sources by where they are in the project, so that the library is the same wherever it is built.
add_compile_options("-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=" "-ffile-prefix-map=${PARTWHEEL_DEPS}/=")
if(PARTWHEEL_PLATFORM)
  # ccache, where scripts/package has it share between clones, makes them relative to build/PLATFORM.
  add_compile_options(-ffile-prefix-map=../=build/ -ffile-prefix-map=../../= -ffile-prefix-map=../deps/=)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # CGAL's interval arithmetic changes the rounding mode. At -O3, g++ 12 suspects std::string of overlapping copies.
  add_compile_options(-frounding-math -Wno-restrict)
endif()

if(PARTWHEEL_SANITIZE)
  add_compile_options(-fsanitize=${PARTWHEEL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${PARTWHEEL_SANITIZE})
  # Eigen's allocator depends on it, and it must be that of the tests, which the release build compiles for any processor.
  add_compile_definitions(EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=1)
  if(PARTWHEEL_SANITIZE MATCHES undefined)
    # What AddressSanitizer asks at each access to memory too: as much code again.
    add_compile_options(-fno-sanitize=null,object-size,vptr)
  endif()
  if(PARTWHEEL_FUZZERS)  # which are led by what has run
    add_compile_options(-fsanitize-coverage=inline-8bit-counters,pc-table)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # What a sanitizer adds makes g++ see uninitialized variables where there are none, in CGAL's headers for one.
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
endif()

add_library(partwheel_flags INTERFACE)
target_compile_options(partwheel_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual -Werror)

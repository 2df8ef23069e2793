# Windows: zig's unwinder declares that its functions are exported. It is compiled anew without that, and linked first.

enable_language(C ASM)
get_filename_component(unwinder "${zig}" DIRECTORY)
string(APPEND unwinder "/lib/libunwind")
set(sources libunwind.cpp Unwind-seh.cpp UnwindLevel1.c UnwindLevel1-gcc-ext.c UnwindRegistersSave.S UnwindRegistersRestore.S)
list(TRANSFORM sources PREPEND "${unwinder}/src/")

add_library(partwheel_unwinder OBJECT ${sources})
target_include_directories(partwheel_unwinder PRIVATE "${unwinder}/include")
target_compile_definitions(partwheel_unwinder PRIVATE _LIBUNWIND_HIDE_SYMBOLS _LIBUNWIND_IS_NATIVE_ONLY)
target_compile_options(partwheel_unwinder PRIVATE -w $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions;-fno-rtti>)
target_link_libraries(partwheel PRIVATE partwheel_unwinder)

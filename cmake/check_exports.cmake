# A test: LIBRARY exports exactly the functions that the headers declare.
#   cmake -DNM=nm -DLIBRARY=libpartwheel.so -DHEADERS=native/include -P check_exports.cmake

file(READ "${HEADERS}/partwheel.h" header)
file(READ "${HEADERS}/partwheel_edit.h" edit)
string(REGEX MATCHALL "PW_API [^;(]*pw_[a-z_0-9]+\\(" declarations "${header}${edit}")
set(declared "")
foreach(declaration IN LISTS declarations)
  string(REGEX MATCH "(pw_[a-z_0-9]+)\\($" declaration "${declaration}")
  list(APPEND declared "${CMAKE_MATCH_1}")
endforeach()
list(SORT declared)

execute_process(COMMAND "${NM}" -D --defined-only "${LIBRARY}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "[^\n]* ([^ \n]+)\n" "\\1;" exported "${symbols}")
list(REMOVE_ITEM exported "")
list(SORT exported)

if(NOT declared)
  message(FATAL_ERROR "no function declaration was found in ${HEADERS}")
endif()
if(NOT exported STREQUAL declared)
  message(FATAL_ERROR "exported and declared functions differ\nexported: ${exported}\ndeclared: ${declared}")
endif()

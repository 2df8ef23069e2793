# A test: LIBRARY exports exactly the functions that HEADER declares.
#   cmake -DNM=nm -DLIBRARY=libpartwheel.so -DHEADER=partwheel.h -P check_exports.cmake

file(READ "${HEADER}" header)
string(REGEX MATCHALL "PW_API [^;(]*pw_[a-z_0-9]+\\(" declarations "${header}")
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
  message(FATAL_ERROR "no function declaration was found in ${HEADER}")
endif()
if(NOT exported STREQUAL declared)
  message(FATAL_ERROR "exported and declared functions differ\nexported: ${exported}\ndeclared: ${declared}")
endif()

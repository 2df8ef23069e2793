# What is installed, and where: the library, its headers, and what CMake and pkg-config need to find them; by itself, as
# the component python, what the Python package needs: the library, and the headers, which declare its functions.

include(CMakePackageConfigHelpers)

# While the major version is 0 a new minor one may change the interface.
set(compatible "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
set_target_properties(partwheel PROPERTIES VERSION "${PROJECT_VERSION}" SOVERSION "${compatible}")
target_link_options(partwheel PRIVATE $<$<CONFIG:Release>:-s>)  # stripped, also where it is copied from here

set(package "${CMAKE_INSTALL_LIBDIR}/cmake/partwheel")
install(TARGETS partwheel EXPORT partwheel)
install(EXPORT partwheel NAMESPACE partwheel:: DESTINATION "${package}" FILE partwheel-config.cmake)
write_basic_package_version_file(partwheel-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/partwheel-config-version.cmake" DESTINATION "${package}")

file(GLOB headers native/include/*.h)
install(FILES ${headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(FILES ${headers} DESTINATION include COMPONENT python EXCLUDE_FROM_ALL)

file(RELATIVE_PATH up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" /)  # so that the installed tree may be moved
string(REGEX REPLACE "/$" "" up "${up}")
configure_file(cmake/partwheel.pc.in partwheel.pc @ONLY)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/partwheel.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

# One file without links. An old one is removed first, so a Blender that has it loaded keeps it.
install(PROGRAMS "$<TARGET_FILE:partwheel>" RENAME "$<TARGET_FILE_PREFIX:partwheel>partwheel$<TARGET_FILE_SUFFIX:partwheel>"
        DESTINATION . COMPONENT python EXCLUDE_FROM_ALL)

# libkiln static and shared from the same objects, installed with kiln::kiln and kiln.pc.
include(CMakePackageConfigHelpers)

add_library(kiln_static STATIC $<TARGET_OBJECTS:kiln_objects>)
add_library(kiln_shared SHARED $<TARGET_OBJECTS:kiln_objects>)
foreach(target kiln_static kiln_shared)
    set_target_properties(${target} PROPERTIES OUTPUT_NAME kiln)
    target_include_directories(${target} INTERFACE
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endforeach()
set_target_properties(kiln_static PROPERTIES EXPORT_NAME kiln_static)
set_target_properties(kiln_shared PROPERTIES EXPORT_NAME kiln VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR})
target_link_libraries(kiln_static PRIVATE OpenEXR::OpenEXRCore PNG::PNG PkgConfig::ZSTD
                      Threads::Threads)
target_link_libraries(kiln_shared PRIVATE OpenEXR::OpenEXRCore PNG::PNG PkgConfig::ZSTD
                      Threads::Threads)
add_library(kiln::kiln ALIAS kiln_shared)
add_library(kiln::kiln_static ALIAS kiln_static)

install(TARGETS kiln_static kiln_shared EXPORT kiln-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES include/kiln/kiln.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kiln)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT kiln-targets NAMESPACE kiln:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/kiln)
configure_package_config_file(cmake/kiln-config.cmake.in kiln-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/kiln)
write_basic_package_version_file(kiln-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/kiln-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/kiln)
file(RELATIVE_PATH KILN_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/kiln.pc.in kiln.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

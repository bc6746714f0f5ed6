# libkiln static and shared from the same objects, installed with kiln::kiln, kiln::kiln_static and
# kiln.pc.
include(CMakePackageConfigHelpers)

add_library(kiln_static STATIC ${KILN_OBJECTS})
if(EMSCRIPTEN) # part of a page: nothing is shared, nothing installed
    target_include_directories(kiln_static INTERFACE include)
    return()
endif()
add_library(kiln_shared SHARED ${KILN_OBJECTS})
kiln_harden(kiln_shared)
foreach(kind static shared)
    set_target_properties(kiln_${kind} PROPERTIES OUTPUT_NAME kiln)
    target_include_directories(kiln_${kind} INTERFACE
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    if(NOT PROJECT_IS_TOP_LEVEL) # part of another project, which links one of the two
        set_target_properties(kiln_${kind} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    endif()
endforeach()
# Until 1.0 each minor version may change what a caller sees.
set_target_properties(kiln_shared PROPERTIES EXPORT_NAME kiln VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(WIN32) # kiln.h then asks the DLL
    target_compile_definitions(kiln_shared INTERFACE KILN_SHARED)
endif()
target_link_libraries(kiln_static PRIVATE ${KILN_USES})
# What the shared library uses is its own affair: installed, it asks for no package.
target_link_libraries(kiln_shared PRIVATE "$<BUILD_INTERFACE:${KILN_USES}>")
add_library(kiln::kiln ALIAS kiln_shared)
add_library(kiln::kiln_static ALIAS kiln_static)
if(NOT KILN_INSTALL)
    return()
endif()

set(KILN_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/kiln)
foreach(kind static shared)
    install(TARGETS kiln_${kind} EXPORT kiln-${kind}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
            RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(EXPORT kiln-${kind} NAMESPACE kiln:: DESTINATION ${KILN_CMAKE_DIR})
endforeach()

install(FILES include/kiln/kiln.h include/kiln/brdf.h include/kiln/course.h include/kiln/check.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kiln)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
configure_package_config_file(cmake/kiln-config.cmake.in kiln-config.cmake
                              INSTALL_DESTINATION ${KILN_CMAKE_DIR} PATH_VARS CMAKE_INSTALL_BINDIR)
write_basic_package_version_file(kiln-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/kiln-config-version.cmake
              cmake/kiln-bake.cmake DESTINATION ${KILN_CMAKE_DIR})
# The way from kiln.pc up to the prefix keeps it valid wherever the tree is moved.
file(RELATIVE_PATH KILN_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/kiln.pc.in kiln.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiln.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# Libraries that kiln can do without. zstd: KTX2 files compressed by it are written and read.
# libdeflate: PNG and EXR files are read faster. libjpeg: JPEG files are read, and written for --for model-viewer. Files of
# other formats are the same bytes either way.
#   kiln_optional(NAME MODULE WHAT): the option KILN_NAME, by default whether pkg-config knows MODULE,
#   and the target PkgConfig::NAME.
find_package(PkgConfig QUIET)
set(KILN_PC_LIBS "")
macro(kiln_optional name module what)
    if(PkgConfig_FOUND AND (KILN_${name} OR NOT CMAKE_CROSSCOMPILING))
        pkg_check_modules(${name} QUIET IMPORTED_TARGET ${module})
    endif()
    if(${name}_FOUND)
        option(KILN_${name} "${what}" ON)
    else()
        option(KILN_${name} "${what}" OFF)
    endif()
    if(KILN_${name} AND NOT ${name}_FOUND)
        message(FATAL_ERROR "KILN_${name} is ON, but pkg-config does not know ${module}: install its "
                "development files, or configure with -D KILN_${name}=OFF")
    endif()
    message(STATUS "${what}: ${KILN_${name}}")
    if(KILN_${name})
        list(APPEND KILN_USES PkgConfig::${name})
        foreach(library ${${name}_LIBRARIES})
            string(APPEND KILN_PC_LIBS " -l${library}")
        endforeach()
    endif()
endmacro()

# cmake -D WRITE=PROGRAM -D READ=PROGRAM -D FOLDER=EMPTY -P check.cmake
foreach(package ktx-parse @khronosgroup/gltf-viewer)
    if(NOT EXISTS "${CMAKE_CURRENT_LIST_DIR}/node_modules/${package}/package.json")
        message(FATAL_ERROR "${package} is missing: run  npm ci --prefix tests/files/ktx")
    endif()
endforeach()
find_program(NODE node)
find_program(OIIOTOOL oiiotool)
if(NOT NODE OR NOT OIIOTOOL)
    message(FATAL_ERROR "node or oiiotool is missing: install nodejs and openimageio-tools")
endif()
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}" "${FOLDER}/foreign")
foreach(command "${WRITE};${FOLDER}" "${NODE};${CMAKE_CURRENT_LIST_DIR}/check.mjs;${FOLDER}"
        "${NODE};--no-deprecation;${CMAKE_CURRENT_LIST_DIR}/libktx.mjs;${FOLDER}"
        "${NODE};${CMAKE_CURRENT_LIST_DIR}/foreign.mjs;${FOLDER}/foreign"
        "${OIIOTOOL};${FOLDER}/blocks.dds;--fullpixels;--scanline;-o;${FOLDER}/oiio.exr"
        "${OIIOTOOL};${FOLDER}/oiio.exr;${FOLDER}/blocks.exr;--fail;0;--diff")
    execute_process(COMMAND ${command} RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "failed: ${command}")
    endif()
endforeach()
file(GLOB foreign "${FOLDER}/foreign/*.ktx2")
list(LENGTH foreign count)
execute_process(COMMAND ${READ} ${foreign} RESULT_VARIABLE result)
if(NOT result EQUAL 0 OR NOT count EQUAL 54)
    message(FATAL_ERROR "not read as written: the ${count} cubes of foreign.mjs, of which there should be 54")
endif()

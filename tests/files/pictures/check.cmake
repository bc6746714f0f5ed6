# cmake -D WRITE=PROGRAM -D FOLDER=EMPTY -P check.cmake: oiiotool reads the PNG files that kiln writes as
# the values that its EXR files hold, and those of halfs as the floats rounded.
find_program(OIIOTOOL oiiotool)
if(NOT OIIOTOOL)
    message(FATAL_ERROR "oiiotool is missing: install openimageio-tools")
endif()
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
execute_process(COMMAND "${WRITE}" "${FOLDER}" COMMAND_ERROR_IS_FATAL ANY)
foreach(channels 1 2 3 4)
    foreach(pair "plain.png;plain.exr;1e-7" "srgb.png;plain.exr;1e-7" "fine.png;fine.exr;1e-7"
            "half.exr;float.exr;2.5e-4")
        list(TRANSFORM pair REPLACE "\\.(png|exr)" "_${channels}.\\1")
        list(GET pair 0 got)
        list(GET pair 1 wanted)
        list(GET pair 2 bound)
        execute_process(COMMAND ${OIIOTOOL} --fail ${bound} --diff ${got} ${wanted}
                        WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE result
                        OUTPUT_VARIABLE said ERROR_VARIABLE said)
        if(NOT result EQUAL 0)
            message(FATAL_ERROR "${got} is not ${wanted} for oiiotool: ${said}")
        endif()
    endforeach()
endforeach()
# The comparison tells files apart.
execute_process(COMMAND ${OIIOTOOL} --fail 1e-7 --diff plain_3.png fine_3.exr RESULT_VARIABLE result
                WORKING_DIRECTORY "${FOLDER}" OUTPUT_QUIET ERROR_QUIET)
if(result EQUAL 0)
    message(FATAL_ERROR "oiiotool sees no difference between 8 and 16 bits")
endif()

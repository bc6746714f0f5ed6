# Khronos's own compiler accepts the shader as it is given to WebGL 2 and ES 3.0.
#   cmake -DINPUT=scene.frag -DSTAGE=frag -DWORK=FOLDER -DGLSLANG=glslangValidator -P valid.cmake
cmake_minimum_required(VERSION 3.22)
set(OUTPUT ${WORK}/${STAGE}.c)
set(NAME unused)
include(${CMAKE_CURRENT_LIST_DIR}/../../scripts/embed.cmake)
file(WRITE ${WORK}/valid.${STAGE} "#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp samplerCube;
${text}")
execute_process(COMMAND ${GLSLANG} ${WORK}/valid.${STAGE} OUTPUT_VARIABLE said RESULT_VARIABLE code)
if(NOT code EQUAL 0 OR said MATCHES "WARNING")
    message(FATAL_ERROR "${said}")
endif()

# Puts a shader into a C file as an array of bytes that ends in NUL, with its #include "FILE" lines
# replaced by the files, once each.
#   cmake -DINPUT=scene.frag -DOUTPUT=scene_frag.c -DNAME=view_shader_scene_frag -P embed.cmake
cmake_minimum_required(VERSION 3.22)
set(seen "")
set(text "")

# Line by line; CMake's lists would swallow semicolons and brackets.
function(embed path)
    if(path IN_LIST seen)
        return()
    endif()
    set(seen "${seen};${path}" PARENT_SCOPE)
    set(seen "${seen};${path}")
    get_filename_component(folder ${path} DIRECTORY)
    file(READ ${path} rest)
    while(rest MATCHES "(^|\n)#include \"([^\"]+)\"[^\n]*(\n|$)")
        set(include "${CMAKE_MATCH_2}")
        string(FIND "${rest}" "#include \"${include}\"" at)
        string(SUBSTRING "${rest}" 0 ${at} before)
        string(APPEND text "${before}")
        embed(${folder}/${include})
        string(SUBSTRING "${rest}" ${at} -1 rest)
        string(FIND "${rest}" "\n" end)
        math(EXPR end "${end} + 1")
        string(SUBSTRING "${rest}" ${end} -1 rest)
    endwhile()
    string(APPEND text "${rest}")
    set(text "${text}" PARENT_SCOPE)
    set(seen "${seen}" PARENT_SCOPE)
endfunction()

get_filename_component(INPUT ${INPUT} ABSOLUTE)
embed(${INPUT})
string(HEX "${text}" hex)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)"
       "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "extern const char ${NAME}[];\nconst char ${NAME}[] = {\n${bytes}0};\n")

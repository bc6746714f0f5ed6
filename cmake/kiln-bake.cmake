# kiln_bake: environments as a part of a build, baked by the command kiln batch.
#
#   kiln_bake(TARGET [ALL]
#             INPUTS picture|pattern|folder ...      relative to the current source folder
#             OUTPUT path                            relative to the current binary folder; holds {name} for several
#             [OPTIONS option ...]                   of kiln bake, and --threads and --memory of kiln batch
#             [BYPRODUCTS file ...])                 baked files that other rules of the build need
#   kiln_bake(TARGET [ALL] MANIFEST list.jsonl [FOLDERS folder ...] [OPTIONS ...] [BYPRODUCTS ...])
#
# Building TARGET bakes what has changed: the build asks for a bake when an input is newer, when a folder or a pattern
# has more or fewer pictures, or when the options change, and kiln then bakes those environments whose inputs, options
# or outputs have other content than before. In a manifest @VARIABLES@ are replaced, as in
# "@CMAKE_CURRENT_SOURCE_DIR@/city.exr", and relative paths begin in the current binary folder. Folders to write into
# are made: that of OUTPUT, and those of FOLDERS.
function(kiln_bake target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "ALL" "OUTPUT;MANIFEST" "INPUTS;OPTIONS;BYPRODUCTS;FOLDERS")
    if(arg_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "kiln_bake(${target}): ${arg_UNPARSED_ARGUMENTS} is not expected")
    endif()
    set(all)
    if(arg_ALL)
        set(all ALL)
    endif()
    set(depends)
    if(arg_MANIFEST AND NOT arg_INPUTS AND NOT arg_OUTPUT)
        get_filename_component(list ${arg_MANIFEST} ABSOLUTE)
        set(words ${CMAKE_CURRENT_BINARY_DIR}/${target}.jsonl)
        configure_file(${list} ${words} @ONLY)
        set(depends ${words})
    elseif(arg_INPUTS AND arg_OUTPUT AND NOT arg_MANIFEST)
        set(words)
        foreach(input IN LISTS arg_INPUTS)
            get_filename_component(input ${input} ABSOLUTE)
            list(APPEND words ${input})
        endforeach()
        get_filename_component(output ${arg_OUTPUT} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
        get_filename_component(folder ${output} DIRECTORY)
        list(APPEND arg_FOLDERS ${folder})
        list(APPEND words --output ${output})
    else()
        message(FATAL_ERROR "kiln_bake(${target}) takes either INPUTS and OUTPUT or MANIFEST")
    endif()
    foreach(folder IN LISTS arg_FOLDERS)
        get_filename_component(folder ${folder} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
        file(MAKE_DIRECTORY ${folder})
    endforeach()
    if(TARGET kiln_cli)
        set(command kiln_cli)
    else()
        find_program(KILN_COMMAND kiln HINTS ${kiln_COMMAND_DIR} DOC "The command kiln")
        set(command ${KILN_COMMAND})
        if(NOT KILN_COMMAND)
            message(FATAL_ERROR "kiln_bake(${target}): the command kiln is not found, set KILN_COMMAND to its path")
        endif()
    endif()
    set(stamp ${CMAKE_CURRENT_BINARY_DIR}/${target}.stamp)
    add_custom_command(
        OUTPUT ${stamp}
        BYPRODUCTS ${arg_BYPRODUCTS}
        COMMAND ${command} batch ${words} ${arg_OPTIONS} --stamp ${stamp} --depfile ${stamp}.d
        DEPFILE ${stamp}.d
        DEPENDS ${command} ${depends}
        WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
        COMMENT "Baking ${target}"
        USES_TERMINAL VERBATIM)
    add_custom_target(${target} ${all} DEPENDS ${stamp})
endfunction()

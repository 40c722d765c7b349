# Validates one scene of scenes/ with the installed POV-Ray, at a small size, against the limits that
# hold for exact features. Wants PROGRAM, SCENE (a .toml) and REPORT (a folder).
set(parity_limit 0.9999)
set(exactness_limit 0.999)
get_filename_component(name ${SCENE} NAME_WE)

find_program(povray povray)
if(NOT povray AND NOT DEFINED ENV{PENUMBRA_POVRAY})
    message("SKIPPED: POV-Ray is not installed")
    return()
endif()

get_filename_component(reports ${REPORT} DIRECTORY)
file(MAKE_DIRECTORY ${reports})
# --strict: a scene of our own must lose nothing.
execute_process(COMMAND ${PROGRAM} validate ${SCENE} --size 160x120 --report ${REPORT} --strict --json
    OUTPUT_VARIABLE json ERROR_VARIABLE messages RESULT_VARIABLE code)
if(NOT code EQUAL 0)
    message(FATAL_ERROR "penumbra validate ended with ${code}: ${messages}${json}")
endif()
foreach(metric parity exactness)
    string(JSON ${metric} GET ${json} cases 0 metrics ${metric} value)
    if(NOT ${metric} GREATER_EQUAL ${${metric}_limit})
        string(JSON worst GET ${json} cases 0 worst_pixel)
        message(FATAL_ERROR
            "${metric} is ${${metric}}, the limit ${${metric}_limit}; worst pixel: ${worst}; see ${REPORT}/index.html")
    endif()
endforeach()
message(STATUS "${name}: parity ${parity}, exactness ${exactness}")

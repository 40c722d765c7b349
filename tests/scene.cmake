# Validates one scene of scenes/ with the installed POV-Ray, at a small size, against the limits that
# hold for exact features. Wants PROGRAM, SCENE (a .toml) and REPORT (a folder).
set(parity_limit 0.9999)
set(exactness_limit 0.999)
# Curved mirrors and lenses magnify the rounding of a hit point, so that a shadow's or a checker's
# edge moves by a pixel here and there.
get_filename_component(name ${SCENE} NAME_WE)
if(name MATCHES "^(mirrors|glass|lights)$")
    set(parity_limit 0.9995)
endif()

find_program(povray povray)
if(NOT povray AND NOT DEFINED ENV{PENUMBRA_POVRAY})
    message("SKIPPED: POV-Ray is not installed")
    return()
endif()

execute_process(COMMAND ${PROGRAM} validate ${SCENE} --size 160x120 --report ${REPORT} --json --quiet
    OUTPUT_VARIABLE json ERROR_VARIABLE messages RESULT_VARIABLE code)
if(NOT code EQUAL 0)
    message(FATAL_ERROR "penumbra validate ended with ${code}: ${messages}${json}")
endif()
if(messages MATCHES "warning:")
    message(FATAL_ERROR "a scene of our own loses something: ${messages}")
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

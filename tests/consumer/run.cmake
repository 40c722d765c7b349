# Installs penumbra to a scratch prefix, builds this folder's project against the package, runs it,
# and checks that the README shows the very program that was built.
#
# Wants BUILD_DIR, MODULE_DIR (relative to the prefix), INSTALLED_MODULE_DIR, CONFIG, CXX, CXX_FLAGS,
# LINK_FLAGS and SCENE.
set(here ${CMAKE_CURRENT_LIST_DIR})
set(work ${BUILD_DIR}/package)
file(REMOVE_RECURSE ${work})

execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${work}/prefix
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
# Moved, so that nothing can rely on where it was installed.
file(RENAME ${work}/prefix ${work}/moved)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${here} -B ${work}/build -G Ninja
    -D CMAKE_BUILD_TYPE=${CONFIG} -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_CXX_FLAGS=${CXX_FLAGS}
    -D CMAKE_EXE_LINKER_FLAGS=${LINK_FLAGS} -D CMAKE_PREFIX_PATH=${work}/moved
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${work}/build COMMAND_ERROR_IS_FATAL ANY)

set(ENV{PENUMBRA_MODULE_DIR} ${work}/moved/${MODULE_DIR})
execute_process(COMMAND ${work}/build/consumer ${SCENE} WORKING_DIRECTORY ${work}
    OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "${output}")
if(NOT output MATCHES "green in the middle: 0\\.[0-9]*[1-9]")
    message(FATAL_ERROR "the consumer printed no brightness: ${output}")
endif()
foreach(file picture.png picture.pov picture.ini)
    if(NOT EXISTS ${work}/${file})
        message(FATAL_ERROR "the consumer wrote no ${file}")
    endif()
endforeach()
# The installed program finds its image module, which an .exr needs, beside itself, wherever the prefix
# was moved, and nowhere else: neither in the build folder nor where the prefix was before.
unset(ENV{PENUMBRA_MODULE_DIR})
if(EXISTS ${work}/moved/bin/penumbra)
    set(render ${work}/moved/bin/penumbra render ${SCENE} --size 32x24 --quiet -o)
    execute_process(COMMAND ${render} ${work}/program.exr COMMAND_ERROR_IS_FATAL ANY)
    file(RENAME ${work}/moved/${MODULE_DIR} ${work}/modules)
    execute_process(COMMAND ${render} ${work}/without.exr RESULT_VARIABLE status ERROR_VARIABLE problem)
    # Not to be asked where penumbra is installed for good.
    if(NOT EXISTS ${INSTALLED_MODULE_DIR} AND NOT status EQUAL 4)
        message(FATAL_ERROR "without its image module the program ends with ${status}: ${problem}")
    endif()
endif()

file(READ ${here}/main.cpp program)
file(READ ${here}/../../README.md readme)
string(FIND "${readme}" "${program}" place)
if(place EQUAL -1)
    message(FATAL_ERROR "README.md does not show tests/consumer/main.cpp as it is")
endif()

cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# A parent takes rosin in its WAY, and is built and installed; a client finds the parent's package and runs.
file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
function(build name)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/${name} -B ${WORK}/${name} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
      -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} "-DCMAKE_PREFIX_PATH=${prefix};${ROSIN_INSTALLED}" ${ARGN}
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/${name} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

build(parent -DWAY=${WAY} -DROSIN_SOURCE=${ROSIN_SOURCE} -DROSIN_INSTALL=${ROSIN_INSTALL})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/parent --prefix ${prefix} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB installed ${prefix}/include/rosin/rosin.hpp ${prefix}/share/cmake/rosin/*)
if(NOT ROSIN_INSTALL AND installed)
  message(FATAL_ERROR "the parent's installation holds what nobody asked for: ${installed}")
endif()
build(client)
execute_process(COMMAND ${WORK}/client/client COMMAND_ERROR_IS_FATAL ANY)

cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# A checkout whose path holds what a pattern takes for wildcards installs every header all the same.
file(REMOVE_RECURSE ${WORK})
foreach(name IN ITEMS "a [1]" "c*? 'd'")
  set(checkout "${WORK}/${name}/rosin/adapt/rosin")
  file(COPY ${SOURCE}/CMakeLists.txt ${SOURCE}/LICENSE ${SOURCE}/.cmake ${SOURCE}/include DESTINATION "${checkout}")
  execute_process(COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S "${checkout}" -B "${WORK}/${name}/build" -DCMAKE_CXX_COMPILER=${CXX} -DROSIN_BUILD_TESTS=OFF
      -DROSIN_BUILD_EXAMPLES=OFF -DROSIN_BUILD_TOOL=OFF -DROSIN_BUILD_COMPILED=OFF
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --install "${WORK}/${name}/build" --prefix "${WORK}/prefix" OUTPUT_QUIET
    COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE wanted RELATIVE ${SOURCE}/include ${SOURCE}/include/*)
  file(GLOB_RECURSE given RELATIVE ${WORK}/prefix/include ${WORK}/prefix/include/*)
  if(NOT wanted STREQUAL given)
    message(FATAL_ERROR "${name}: installed headers differ from the source tree:\n${wanted}\n${given}")
  endif()
  file(REMOVE_RECURSE "${WORK}/prefix")
endforeach()

cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# Copy include/ into a stranger's tree and call the bare compiler, as a firmware build would. Not a system folder here:
# the headers have to be clean under the stranger's warnings.
file(REMOVE_RECURSE ${WORK})
file(COPY ${SOURCE}/include/rosin DESTINATION ${WORK}/third_party)
execute_process(
  COMMAND ${CXX} -std=c++20 -O1 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Werror
    -fno-exceptions -fno-rtti -I${WORK}/third_party -isystem ${EIGEN} ${MAIN} -o ${WORK}/consumer
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/consumer COMMAND_ERROR_IS_FATAL ANY)

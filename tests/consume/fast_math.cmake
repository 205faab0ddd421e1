cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# A consumer's -ffast-math: headers that need NaN say so in one sentence, with -fno-finite-math-only they compile, and what runs on an
# instrument gives the same numbers with it.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(here ${CMAKE_CURRENT_LIST_DIR}/fast_math)
set(compile ${CXX} -std=c++20 -I${SOURCE}/include -isystem ${EIGEN})
file(WRITE ${WORK}/all.cpp "#include <rosin/rosin.hpp>\n")
execute_process(COMMAND ${compile} -ffast-math -E ${WORK}/all.cpp -o ${WORK}/all.i RESULT_VARIABLE result ERROR_VARIABLE said)
if(result EQUAL 0 OR NOT said MATCHES "add -fno-finite-math-only")
  message(FATAL_ERROR "-ffast-math is not refused in words:\n${said}")
endif()
execute_process(COMMAND ${compile} -ffast-math -fno-finite-math-only -E ${WORK}/all.cpp -o ${WORK}/all.i COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${compile} -O2 -DRUN=run_exact -c ${here}/run.cpp -o ${WORK}/exact.o COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${compile} -O2 -ffast-math -DRUN=run_fast -c ${here}/run.cpp -o ${WORK}/fast.o COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${compile} -O1 ${here}/main.cpp ${WORK}/exact.o ${WORK}/fast.o -o ${WORK}/fast_math COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/fast_math COMMAND_ERROR_IS_FATAL ANY)

cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
foreach(program IN ITEMS ONE OTHER)
  execute_process(COMMAND ${${program}} OUTPUT_VARIABLE ${program}_output COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(NOT ONE_output STREQUAL OTHER_output OR ONE_output STREQUAL "")
  message(FATAL_ERROR "header-only:\n${ONE_output}\ncompiled:\n${OTHER_output}")
endif()

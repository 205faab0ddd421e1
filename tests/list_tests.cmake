cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# Asks a doctest program for its test cases and writes one add_test() each; those of the test suite "long" have that label, too.
# (doctest's own module splits names at semicolons and brackets, and then runs filters that match nothing, which pass.)

# Characters that mean something to CMake's lists become ones that mean nothing.
string(ASCII 1 semicolon)
string(ASCII 2 open)
string(ASCII 3 close)

function(test_cases out)
  execute_process(COMMAND ${PROGRAM} --list-test-cases --no-colors=true ${ARGN} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE ";" "${semicolon}" output "${output}")
  string(REPLACE "[" "${open}" output "${output}")
  string(REPLACE "]" "${close}" output "${output}")
  string(REGEX MATCHALL "[^\n]+" lines "${output}")
  list(FILTER lines EXCLUDE REGEX "^(${open}doctest${close}|===)")
  list(REMOVE_DUPLICATES lines)
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()

test_cases(names)
test_cases(long --test-suite=long)
if(NOT names)
  message(FATAL_ERROR "${PROGRAM} has no test cases")
endif()

set(script "")
foreach(line IN LISTS names)
  string(REGEX REPLACE "[${semicolon}${open}${close},\"\\]" "?" filter "${line}")  # ? matches any one character
  string(REPLACE "${semicolon}" "," name "${line}")
  string(REPLACE "${open}" "(" name "${name}")
  string(REPLACE "${close}" ")" name "${name}")
  set(labels ${LABEL})
  if(line IN_LIST long)
    list(APPEND labels long)
  endif()
  string(APPEND script
    "add_test([==[${PREFIX}${name}]==] [==[${PROGRAM}]==] [==[--test-case=${filter}]==])\n"
    "set_tests_properties([==[${PREFIX}${name}]==] PROPERTIES LABELS [==[${labels}]==] FAIL_REGULAR_EXPRESSION [==[test cases: +0 ]==])\n")
endforeach()
file(WRITE ${OUTPUT} "${script}")

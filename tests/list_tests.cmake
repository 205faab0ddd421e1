cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# Asks a doctest program for its test cases and writes one add_test() each. (doctest's own module splits names at
# semicolons and brackets, and then runs filters that match nothing, which pass.)
execute_process(COMMAND ${PROGRAM} --list-test-cases --no-colors=true OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)

# Characters that mean something to CMake's lists become ones that mean nothing.
string(ASCII 1 semicolon)
string(ASCII 2 open)
string(ASCII 3 close)
string(REPLACE ";" "${semicolon}" output "${output}")
string(REPLACE "[" "${open}" output "${output}")
string(REPLACE "]" "${close}" output "${output}")
string(REGEX MATCHALL "[^\n]+" lines "${output}")

set(script "")
set(seen "")
foreach(line IN LISTS lines)
  if(line MATCHES "^(${open}doctest${close}|===)" OR line IN_LIST seen)
    continue()
  endif()
  list(APPEND seen "${line}")
  string(REGEX REPLACE "[${semicolon}${open}${close},\"\\]" "?" filter "${line}")  # ? matches any one character
  string(REPLACE "${semicolon}" "," name "${line}")
  string(REPLACE "${open}" "(" name "${name}")
  string(REPLACE "${close}" ")" name "${name}")
  string(APPEND script
    "add_test([==[${PREFIX}${name}]==] [==[${PROGRAM}]==] [==[--test-case=${filter}]==])\n"
    "set_tests_properties([==[${PREFIX}${name}]==] PROPERTIES LABELS ${LABEL} FAIL_REGULAR_EXPRESSION [==[test cases: +0 ]==])\n")
endforeach()
if(NOT seen)
  message(FATAL_ERROR "${PROGRAM} has no test cases")
endif()
file(WRITE ${OUTPUT} "${script}")

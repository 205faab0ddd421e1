cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# Tolerances of tests are relative (tests/support/approx.hpp): doctest's own allow epsilon (1 + |value|), which nothing small can miss.
file(GLOB_RECURSE tests RELATIVE ${ROOT} ${ROOT}/tests/*.cpp ${ROOT}/tests/*.hpp)
foreach(test IN LISTS tests)
  file(STRINGS ${ROOT}/${test} lines REGEX "doctest::Approx\\(")
  if(lines AND NOT test STREQUAL "tests/support/approx.hpp")
    message(SEND_ERROR "${test}: test::approx() instead of doctest::Approx()")
  endif()
endforeach()

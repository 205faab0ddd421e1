cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# A link or picture that points into the tree points at something.
file(GLOB_RECURSE pages ${ROOT}/*.md)
list(FILTER pages EXCLUDE REGEX "^${ROOT}/(build|\\.git)/")
foreach(page IN LISTS pages)
  cmake_path(GET page PARENT_PATH folder)
  file(READ ${page} text)
  string(REGEX REPLACE "[][;]" "" text "${text}")  # brackets and semicolons upset CMake's lists
  string(REGEX MATCHALL "\\(([^() \n]+)\\)" links "${text}")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^\\(|\\)$|#.*\\)$" "" target "${link}")
    if(target MATCHES "^(https?:|mailto:|#|$)" OR NOT target MATCHES "/|[.](md|svg|png|cpp|hpp|sh|toml|json|csv|html)$")
      continue()
    endif()
    if(NOT EXISTS ${folder}/${target})
      message(SEND_ERROR "${page} points to ${target}, which is not there")
    endif()
  endforeach()
endforeach()

# rosin::compiled: the same headers, with what is only ever used in double compiled once, in a library (core/instantiate.hpp).
# Whoever links it has ROSIN_COMPILED defined. Nobody who links rosin::rosin notices it.
rosin_glob(compiled_parts include/rosin/compiled/*.ipp)
set(compiled_sources "")
foreach(part IN LISTS compiled_parts)
  cmake_path(GET part STEM name)
  set(source ${PROJECT_BINARY_DIR}/compiled/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include <rosin/compiled/${name}.ipp>\n")
  list(APPEND compiled_sources ${source})
endforeach()

add_library(rosin_compiled STATIC ${compiled_sources})
add_library(rosin::compiled ALIAS rosin_compiled)
target_link_libraries(rosin_compiled PUBLIC rosin::rosin)
target_compile_definitions(rosin_compiled PUBLIC ROSIN_COMPILED)
set_target_properties(rosin_compiled PROPERTIES EXPORT_NAME compiled POSITION_INDEPENDENT_CODE ON)
if(ROSIN_INSTALL_COMPILED OR NOT ROSIN_INSTALL)
  install(TARGETS rosin_compiled EXPORT rosin-targets ARCHIVE ${unasked})
endif()

# The library that the tool loads, once for any x86-64 and once for x86-64-v3 (AVX2, FMA: since about 2013). The loader takes what
# the machine has (glibc-hwcaps, glibc 2.33 and later). Both hide all that is not compiled once by name, since Eigen's functions of
# one name differ between the levels; and all, the tool too, align as much, since a matrix made here may be freed there.
set(ROSIN_TOOL_LIBRARY ${PROJECT_BINARY_DIR}/lib/rosin)
foreach(level IN ITEMS x86-64 x86-64-v3)
  set(target rosin_level_${level})
  add_library(${target} SHARED ${compiled_sources})
  target_link_libraries(${target} PUBLIC rosin::rosin)
  target_compile_definitions(${target} PUBLIC ROSIN_COMPILED EIGEN_MAX_ALIGN_BYTES=32
    PRIVATE [[ROSIN_INSTANTIATE_EXPORT=__attribute__((visibility("default")))]])
  set(folder ${ROSIN_TOOL_LIBRARY})
  if(NOT level STREQUAL "x86-64")
    set(folder ${folder}/glibc-hwcaps/${level})
    target_compile_options(${target} PRIVATE -march=${level})
  endif()
  set_target_properties(${target} PROPERTIES OUTPUT_NAME rosin_compiled LIBRARY_OUTPUT_DIRECTORY ${folder}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_options(${target} PRIVATE LINKER:-Bsymbolic)
  if(ROSIN_INSTALL)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_BINARY_DIR} OUTPUT_VARIABLE destination)
    install(TARGETS ${target} LIBRARY DESTINATION ${destination} COMPONENT tool)
  endif()
endforeach()

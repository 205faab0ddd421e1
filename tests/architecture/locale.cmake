cmake_minimum_required(VERSION 3.25)  # a -P script starts with no policies set
# Headers and tool write and read numbers with std::to_chars and std::from_chars (core/number_text.hpp), never with what asks the locale
# of the program. std::to_string and std::stod of floating point do not compile where .cmake/numbers_without_locale.hpp is included.
set(refused "[^a-z_](s|sn|vsn|vs|f|vf|d|asp|)printf *\\(|[^a-z_](s|f|)scanf *\\(|[^a-z_]strto(d|f|ld) *\\(|[^a-z_]ato(f|i|l) *\\(")
string(APPEND refused "|std::stof|std::stod|std::stold|setprecision|std::put_money|std::format *\\(|setlocale")
foreach(folder IN ITEMS include/rosin examples/rosin)
  file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp)
  foreach(source IN LISTS sources)
    file(STRINGS ${ROOT}/${source} lines REGEX "${refused}")
    foreach(line IN LISTS lines)
      if(NOT line MATCHES "^ *//")
        message(SEND_ERROR "${source}: rosin::number_text or rosin::number_from instead of\n  ${line}")
      endif()
    endforeach()
  endforeach()
endforeach()

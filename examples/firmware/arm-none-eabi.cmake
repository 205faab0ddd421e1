# Toolchain file: Debian's gcc-arm-none-eabi with its newlib and libstdc++.
#   cmake -S examples/firmware -B build-m4 --toolchain arm-none-eabi.cmake -DPART=stm32f405
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # nothing can be linked before there is a linker script
set(CMAKE_EXECUTABLE_SUFFIX_CXX .elf)

// SPDX-License-Identifier: MIT
//
// The little that this program needs of a board: files and text by semihosting (a debugger or an emulator serves them), and
// the core's own timer. On a product the converter's and the serial port's drivers stand here.
//
#pragma once

#include <cstddef>
#include <cstdint>

namespace board {

/// Arm semihosting: operation and parameter in r0 and r1, answer in r0.
inline int call(int operation, const void* parameter) {
  register int r0 asm("r0") = operation;
  register const void* r1 asm("r1") = parameter;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

inline void say(const char* text) { call(0x04, text); }

inline void say(std::uint32_t number) {
  char text[11];
  char* at = text + 10;
  *at = 0;
  do *--at = static_cast<char>('0' + number % 10);
  while ((number /= 10) != 0);
  say(at);
}

[[noreturn]] inline void exit(int code) {
  const std::uint32_t block[2]{0x20026, static_cast<std::uint32_t>(code)};
  for (;;) call(0x20, block);
}

enum class mode : std::uint32_t { read = 1, write = 5 };

/// < 0: no such file.
inline int open(const char* name, std::size_t length, mode how) {
  const std::uint32_t block[3]{reinterpret_cast<std::uintptr_t>(name), static_cast<std::uint32_t>(how), length};
  return call(0x01, block);
}
/// Bytes that were not read; not written.
inline std::size_t read(int file, void* to, std::size_t bytes) {
  const std::uint32_t block[3]{static_cast<std::uint32_t>(file), reinterpret_cast<std::uintptr_t>(to), bytes};
  return static_cast<std::size_t>(call(0x06, block));
}
inline std::size_t write(int file, const void* from, std::size_t bytes) {
  const std::uint32_t block[3]{static_cast<std::uint32_t>(file), reinterpret_cast<std::uintptr_t>(from), bytes};
  return static_cast<std::size_t>(call(0x05, block));
}

/// SysTick on the core's clock, counting down over 24 bits: on a part it counts cycles. An emulator that is told to take one
/// nanosecond for an instruction counts instructions with it, in the unit that main() finds on a loop of known length.
inline volatile std::uint32_t* const systick = reinterpret_cast<volatile std::uint32_t*>(0xE000E010);
inline void start_timer() {
  systick[1] = 0xFFFFFF;
  systick[2] = 0;
  systick[0] = 5;
}
inline std::uint32_t now() { return systick[2]; }
inline std::uint32_t ticks_since(std::uint32_t then) { return (then - now()) & 0xFFFFFFU; }

}  // namespace board

// SPDX-License-Identifier: MIT
//
// From reset to main() on a Cortex-M4F or M7: variables, floating-point unit, constructors. No vendor's code.
//
#include <algorithm>
#include <cstdint>

#include "board.hpp"

extern "C" {
extern std::uint32_t stack_top, data_begin, data_end, bss_begin, bss_end;
extern const std::uint32_t data_image;
using constructor = void (*)();
extern const constructor init_begin, init_end;
int main();

[[noreturn]] void reset();
[[noreturn]] void fault();
}

namespace {

using entry = void (*)();
/// Initial stack pointer, reset, and the faults; this program asks for no interrupts.
struct vector_table {
  const void* stack;
  entry entries[15];
};
[[gnu::section(".vectors"), gnu::used]] const vector_table vectors{
    &stack_top,
    {reset, fault, fault, fault, fault, fault, nullptr, nullptr, nullptr, nullptr, fault, fault, nullptr, fault, fault}};

auto& coprocessor_access = *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88);

}  // namespace

// Before the unit is on, nothing may touch a floating-point register: the rest is a function of its own.
[[gnu::noinline, noreturn]] static void run() {
  std::copy(&data_image, &data_image + (&data_end - &data_begin), &data_begin);
  std::fill(&bss_begin, &bss_end, 0U);
  for (const constructor* c = &init_begin; c != &init_end; ++c) (*c)();
  board::exit(main());
}

void reset() {
  coprocessor_access = coprocessor_access | 0xFU << 20U;
  asm volatile("dsb\n isb" ::: "memory");
  run();
}

void fault() {
  board::say("fault\n");
  board::exit(2);
}

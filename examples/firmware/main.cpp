// SPDX-License-Identifier: MIT
//
// Force and velocity under the bow on a microcontroller. process_block() is what the interrupt of the converter's DMA would call;
// here the blocks come from a file of the host and go to another, and the core's timer counts what each of them took.
//
#include "board.hpp"
#include "rig.hpp"  // written by rosin fit --emit-header

#include <array>
#include <span>

namespace {

#ifndef BLOCK
#define BLOCK 16
#endif
constexpr std::size_t block = BLOCK;

rig::reconstructor under_the_bow{rig::coefficients};

std::array<rosin::termination_frame<rig::sample>, block> forces;
std::array<rosin::bow_frame<rig::sample>, block> bow;

/// Newtons as recorded in, newtons and metres a second out, later by coefficients.latency frames.
void process_block() {
  for (auto& frame : forces) frame.near_N -= rig::offset.near_N, frame.far_N -= rig::offset.far_N;
  under_the_bow.process(forces, bow);
}

/// Two instructions a turn.
[[gnu::noinline]] void loop(std::uint32_t turns) { asm volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(turns)::"cc"); }

void report(const char* what, std::uint32_t number) {
  board::say(what);
  board::say(" ");
  board::say(number);
  board::say("\n");
}

}  // namespace

int main() {
  const int in = board::open("forces.f32", 10, board::mode::read);
  const int out = board::open("bow.f32", 7, board::mode::write);
  if (in < 0 || out < 0) return 1;
  board::start_timer();
  const std::uint32_t before_loop = board::now();
  loop(500000);
  report("ticks of 1000000 instructions", board::ticks_since(before_loop));

  std::uint32_t frames = 0, ticks = 0, worst = 0, blocks = 0;
  while (board::read(in, forces.data(), sizeof forces) == 0) {
    const std::uint32_t start = board::now();
    process_block();
    const std::uint32_t took = board::ticks_since(start);
    if (board::write(out, bow.data(), sizeof bow) != 0) return 1;
    frames += block;
    ++blocks;
    ticks += took;
    worst = took > worst ? took : worst;
  }
  report("frames", frames);
  report("frames a block", block);
  report("blocks timed", blocks);
  report("ticks in all", ticks);
  report("ticks of the longest block", worst);
  report("bytes of the reconstruction", sizeof under_the_bow);
  return 0;
}

# emulated.sh TOOL: the commands of docs/howto/firmware.md word for word (Cortex-M4F, 48 kHz), then the same on a Cortex-M7 at 128 kHz.
# Each run is compared with the desktop, counts its instructions, and has to leave room in the time of a frame.
set -euo pipefail
page=$ROSIN_SOURCE/docs/howto/firmware.md
PATH=$(dirname "$1"):$PATH
rm -rf tried && mkdir tried && cd tried
for entry in examples include tests; do ln -s "$ROSIN_SOURCE/$entry" .; done
fail() { echo "FAILED: $*"; exit 1; }

awk '/^```sh/ { run = 1; next } /^```/ { run = 0 } run' "$page" >commands.sh
[ "$(grep -c . commands.sh)" -ge 8 ] || fail "the page has no commands"
bash -euo pipefail commands.sh | tee m4.txt

# counted FILE EXPECTED_TICKS: instructions per frame out of what the firmware printed. One instruction is one nanosecond to the
# emulator; the loop of known length says how many ticks that makes, and the timer's frequency has to agree.
counted() {
  awk -v expected="$2" '
    /^ticks of 1000000/ { unit = $NF / 1e6 } /^frames a block/ { block = $NF } /^blocks timed/ { blocks = $NF }
    /^ticks in all/ { ticks = $NF } /^ticks of the longest/ { worst = $NF }
    END {
      if (unit * 1e6 < 0.999 * expected || unit * 1e6 > 1.001 * expected || blocks < 100) exit 1
      printf "%.0f %.0f\n", ticks / unit / blocks / block, worst / unit / block }' "$1"
}
# fits PART FILE TICKS_OF_LOOP CLOCK_HZ RATE_HZ CYCLES_PER_INSTRUCTION SHARE: cycles per frame stay below that share of what there is.
fits() {
  local mean worst
  read -r mean worst < <(counted "$2" "$3") || fail "$1: the count of instructions is not to be trusted: $(cat "$2")"
  awk -v part="$1" -v mean="$mean" -v worst="$worst" -v clock="$4" -v rate="$5" -v each="$6" -v share="$7" 'BEGIN {
    part_used = worst * each * rate / clock
    printf "%s: %d instructions a frame, %d in the longest block; at %s cycles each %.0f %% of %d MHz at %d kHz\n", part, mean, worst, each, 100 * part_used, clock / 1e6, rate / 1e3
    exit part_used > share }' || fail "$1: too many instructions"
}
fits Cortex-M4F m4.txt 168000 168e6 48000 3 0.6

soft=$(arm-none-eabi-nm firmware/build/firmware.elf | grep -E '__aeabi_(d|f2d|i2d|ui2d|f[a-z]+$)' || true)
[ -z "$soft" ] || fail "double precision or soft floats in the M4F's program: $soft"
! arm-none-eabi-nm firmware/build/firmware.elf | grep -E ' (malloc|_malloc_r|free|_Znwj|__cxa_throw|__cxa_guard_acquire)$' || fail "heap or exceptions"

rosin fit rig --emit-header firmware/rig.hpp --emit-rate 128000 --force >/dev/null
cmake -S firmware -B firmware/build-m7 --toolchain arm-none-eabi.cmake -DPART=mps2_an500 >/dev/null
cmake --build firmware/build-m7 >/dev/null
g++ -std=c++20 -O2 -I firmware -I firmware/vendor tests/firmware/desktop.cpp -o desktop
rm bow.f32
qemu-system-arm -machine mps2-an500 -icount shift=0 -nographic -monitor none -serial none \
  -semihosting-config enable=on,target=native -kernel firmware/build-m7/firmware.elf 2>&1 | tee m7.txt
./desktop compare
fits Cortex-M7 m7.txt 25000 480e6 128000 1.5 0.6

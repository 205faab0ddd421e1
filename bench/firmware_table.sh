#!/usr/bin/env bash
# firmware_table.sh ROSIN RIG SCRATCH: instructions a frame of examples/firmware on emulated cores, for the rates and errors of the table in
# docs/howto/firmware.md; forces come from RIG/bow-1.wav. Not a test: tests/firmware/emulated.sh is.
set -euo pipefail
rosin=$1 rig=$2 scratch=$3 root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$scratch" && cd "$scratch"
measure() {  # PART MACHINE -> "mean worst"
  cmake -S "$root/examples/firmware" -B "build-$1" --toolchain arm-none-eabi.cmake -DPART="$1" -DROSIN_INCLUDE="$root/include" -DRIG_HEADER="$PWD/rig.hpp" >/dev/null
  cmake --build "build-$1" >/dev/null
  qemu-system-arm -machine "$2" -icount shift=0 -nographic -monitor none -serial none -semihosting-config enable=on,target=native -kernel "build-$1/firmware.elf" 2>&1 |
    awk '/^ticks of 1000000/ { u = $NF / 1e6 } /^frames a/ { b = $NF } /^blocks/ { n = $NF } /in all/ { t = $NF } /longest/ { w = $NF } END { printf "%.0f %.0f", t / u / n / b, w / u / b }'
}
echo "| rate, kHz | version | error | taps | latency, ms | M4F: instructions | of 168 MHz | M7: instructions | of 480 MHz |"
echo "|---|---|---|---|---|---|---|---|---|"
for rate in 48000 96000 128000 192000; do
  for version in both near; do
    for error in 0.01 0.001 0.0003; do
      said=$("$rosin" fit "$rig" --emit-header rig.hpp --emit-rate $rate --emit-error $error --emit-version $version --force | tail -n 1)
      [ -e forces.f32 ] || { g++ -std=c++20 -O2 -I. -I"$root/include" "$root/tests/firmware/desktop.cpp" -o desktop && ./desktop record "$rig/bow-1.wav" 1.65 1.96; }
      read -r m4 m4_worst < <(measure stm32f405 netduinoplus2; echo)
      read -r m7 m7_worst < <(measure mps2_an500 mps2-an500; echo)
      taps=$(sed 's/.*: \([0-9]*\) taps.*/\1/' <<<"$said") late=$(sed 's/.*(\([0-9.]*\) ms).*/\1/' <<<"$said")
      awk -v r=$rate -v v=$version -v e=$error -v t="$taps" -v l="$late" -v a="$m4" -v aw="$m4_worst" -v b="$m7" -v bw="$m7_worst" 'BEGIN {
        printf "| %d | %s | %s | %d | %s | %d | %.0f %% | %d | %.0f %% |\n", r / 1e3, v, e, t, l, a, 100 * aw * 3 * r / 168e6, b, 100 * bw * 1.5 * r / 480e6 }'
    done
  done
done

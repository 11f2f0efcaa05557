#!/usr/bin/env bash
# Measures a graphics processor with a program that was built elsewhere with the feature gpu: correctness first, then times. Builds
# nothing and needs no network; a few minutes on a card.
#
#   PERICLES=target/gpu/release/pericles benches/gpu/run.sh [DEVICE]     DEVICE: gpu (default), gpu:1, ...
#
# Prints the rows of the table in book/src/how-to/gpu.md; all results are left in ./gpu-results.
set -euo pipefail
cd "$(dirname "$0")/../.."
pericles=${PERICLES:-target/gpu/release/pericles}
device=${1:-gpu}
out=gpu-results
mkdir -p "$out"
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$out}
deck=examples/fracture/branching.toml

"$pericles" devices | tee "$out/devices.txt"

echo "== correctness: crack branching on the processor and on the device"
for precision in double mixed; do
    "$pericles" run "$deck" --quiet --force --out "$out/$precision" --device "$device" --precision "$precision" --set time.end=30us ||
        { echo "no $precision precision"; continue; }
    [ -d "$out/cpu" ] || "$pericles" run "$deck" --quiet --out "$out/cpu" --device cpu --set time.end=30us
    # Differences of the momentum are those of round-off.
    "$pericles" diff "$out/cpu" "$out/$precision" --tolerance 1e-6 >"$out/$precision.diff" || true
    grep exceeds "$out/$precision.diff" | grep -v momentum_ || echo "$precision: all fields and columns equal to 1e-6"
    tail -1 "$out/$precision/history.csv"
done

echo "== steps of blocks, beside the ceilings of the device"
"$pericles" bench --device "$device" --json "$out/bench.json" | tee "$out/bench.txt"
"$pericles" bench block-384 --device "$device" --json "$out/bench-384.json" || echo "block-384 does not fit"

echo "== whole runs: the branching plate on the device and on all cores, then with 20 outputs and history every 100 steps"
seconds() { grep -o '"wall_seconds": *[0-9.]*' "$1/run.json" | head -1; }
quiet=(--set output.fields.every=1000000 --set output.history.every=1000000)
for place in "$device" cpu; do
    "$pericles" run "$deck" --quiet --force --out "$out/bare" --device "$place" "${quiet[@]}"
    echo "$place without output: $(seconds "$out/bare")"
    "$pericles" run "$deck" --quiet --force --out "$out/written" --device "$place" --set output.fields.count=20 --set output.history.every=100
    echo "$place with output: $(seconds "$out/written")"
done

#!/usr/bin/env bash
# Searches a compiled program for calls in loops that are compiled for vector instructions. A function that is not inlined there uses baseline
# instructions and passes all registers through memory, which makes loops up to three times slower without a failing test. Panics, memory copies,
# indirect calls, expm1 (coefficients of viscous points) and `_of_moment` (stress of correspondence points), which are called once per point and not per
# bond, are ignored. The result does not depend on the machine's speed.
#
#     .ci/inlined.sh target/release/pericles
set -euo pipefail
program=$1
if ! command -v objdump >/dev/null || [[ $(uname -m) != x86_64 ]]; then
    echo "inlined: needs objdump on x86-64; not checked"
    exit 0
fi
calls=$(objdump --disassemble --demangle --no-show-raw-insn "$program" | awk '
    /^[0-9a-f]+ <.*>:$/ {
        name = substr($0, index($0, "<") + 1)
        sub(/>:$/, "", name)
        loop = name ~ /^pericles(_[a-z]+)?::.*::(avx2|avx512)$/
        loops += loop
    }
    loop && /call / && /</ {
        target = substr($0, index($0, "<") + 1)
        if (target !~ /panic|_fail|_DYNAMIC|GLOBAL_OFFSET|copy_from_slice|mem(cpy|set|move)|^expm1@|_of_moment>$/) print name " calls " target
    }
    END { if (loops < 20) print "only " loops + 0 " vector loops found in the program" }')
if [[ -n $calls ]]; then
    echo "not inlined:"
    sort <<<"$calls" | uniq -c
    exit 1
fi
echo "inlined: no call out of a vector loop"

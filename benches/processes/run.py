#!/usr/bin/env python3
"""Time and memory of runs on several processes, measured in alternation. See README.md."""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
STEPS = (100, 700)
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
LONG = ["--set", 'body.size=["46 mm", "46 mm", "92 mm"]']


def launcher(processes):
    return ["mpirun", "--bind-to", "core", "-n", str(processes)]


def start(options, steps, out, threads=1, before=(), deck=HERE / "block.toml"):
    command = [*before, options.program, "run", str(deck), "--out", out, "--threads", str(threads), "--quiet"]
    command += ["--set", f'time.end="{80 * steps} ns"', *options.changes]
    return subprocess.Popen(command, env=os.environ | MPI, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def seconds(job, out):
    if job.wait() != 0:
        sys.exit(f"a run failed; repeat it: {' '.join(job.args)}")
    return json.loads(Path(out, "run.json").read_text())["progress"]["wall_seconds"]


def per_step(measure):
    """Time of a step, ms, from a short and a long run: without set-up and output."""
    short, long = (measure(steps) for steps in STEPS)
    return 1e3 * (long - short) / (STEPS[1] - STEPS[0])


def one(options, changes=(), **how):
    def measure(steps):
        with tempfile.TemporaryDirectory() as folder:
            out = folder + "/run"
            options.changes = changes
            return seconds(start(options, steps, out, **how), out)

    return lambda: per_step(measure)


def pair(options):
    """Two runs at the same time, each on its core: what the machine allows."""

    def measure(steps):
        with tempfile.TemporaryDirectory() as folder:
            options.changes = ()
            runs = [(start(options, steps, f"{folder}/{k}", before=["taskset", "-c", str(k)]), f"{folder}/{k}") for k in (0, 1)]
            return max(seconds(*run) for run in runs)

    return lambda: per_step(measure)


def lammps(options, processes):
    """Bonds and integration of peri/pmb; the contact list is emptied after the families are built."""
    steps = 40
    folder = Path(options.lammps) / "bin"

    def measure():
        with tempfile.TemporaryDirectory() as out:
            command = [str(folder / "lmp"), "-screen", "none", "-in", "in.block", "-log", f"{out}/log"]
            command += ["-var", "n", "46", "-var", "steps", str(steps)]
            if processes > 1:
                command = [str(folder / "mpiexec"), "-n", str(processes), "-bind-to", "core", *command]
            subprocess.run(command, check=True, env=os.environ | MPI, cwd=HERE.parent / "lammps", stdout=subprocess.DEVNULL)
            times = re.findall(rf"Loop time of (\S+) on \d+ procs for {steps} steps", Path(out, "log").read_text())
            return 1e3 * float(times[-1]) / steps

    return measure


def times(options):
    cases = {
        "one process": one(options),
        "one process of an MPI job": one(options, before=launcher(1)),
        "two threads": one(options, threads=2),
        "two processes": one(options, before=launcher(2)),
        "twice the body, two processes": one(options, changes=LONG, before=launcher(2)),
        "two runs at the same time": pair(options),
    }
    if options.lammps:
        cases["LAMMPS, one process"] = lammps(options, 1)
        cases["LAMMPS, two processes"] = lammps(options, 2)
    found = {name: [] for name in cases}
    for _ in range(options.rounds):
        for name, measure in cases.items():
            found[name].append(measure())
    median = {name: statistics.median(values) for name, values in found.items()}
    for name, values in found.items():
        print(f"{name:32} {median[name]:8.2f} ms per step (fastest {min(values):.2f})")
    alone, two = median["one process"], median["two processes"]
    print(f"two processes: {alone / two:.2f} times one process, {median['two threads'] / two:.2f} times two threads")
    print(f"weak scaling: {alone / median['twice the body, two processes']:.3f}; of the machine: {alone / median['two runs at the same time']:.3f}")
    print(f"one process of an MPI job: {100 * (median['one process of an MPI job'] / alone - 1):+.1f} %")
    if options.lammps:
        print(f"LAMMPS on two processes: {median['LAMMPS, two processes'] / two:.1f} times the time")


def resident(program):
    """Memory of all processes of the program, MB."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if os.readlink(process / "exe") == program:
                found.append(int(re.search(r"VmRSS:\s+(\d+)", (process / "status").read_text()).group(1)) / 1e3)
        except (OSError, AttributeError):
            continue
    return sorted(found)


def memory(options):
    side = round(46 * (options.memory / 46**3) ** (1 / 3))
    options.changes = ["--set", f'body.size=["{side} mm", "{side} mm", "{side} mm"]']
    print(f"{side}^3 = {side**3} points; MB of the process with least and most memory")
    for processes in (1, 2, 4):
        before = [] if processes == 1 else ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(processes)]
        with tempfile.TemporaryDirectory() as folder:
            out = folder + "/run"
            job = start(options, 6, out, before=before)
            phases = {"set-up": [], "run": []}
            while job.poll() is None:
                phases["run" if Path(out, "run.json").exists() else "set-up"].append(resident(options.program) or [0.0])
                time.sleep(0.1)
            if job.returncode != 0:
                sys.exit("a run failed")
        for phase, samples in phases.items():
            peak = max(sample[-1] for sample in samples)
            least = max(sample[0] for sample in samples)
            median = statistics.median(sample[-1] for sample in samples)
            print(f"{processes} processes, {phase}: peak {least:.0f} to {peak:.0f}, median of the largest {median:.0f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="pericles with the feature mpi")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--lammps", help="virtual environment with the packages lammps[mpi] and mpich")
    parser.add_argument("--memory", type=float, help="measure the memory for about this number of points instead of the time")
    arguments = parser.parse_args()
    arguments.program = str(Path(arguments.program).resolve())
    memory(arguments) if arguments.memory else times(arguments)

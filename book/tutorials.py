#!/usr/bin/env python3
"""Runs the decks of the tutorials and writes the figures into book/src/tutorials.

    book/tutorials.py [PROGRAM]
    book/tutorials.py --decks

With --decks it only copies the decks of examples into the pages that show them (a test compares them). PROGRAM is the release build (default target/release/pericles). Decks are the blocks of the tutorials that are marked `deck` and begin with a comment `# NAME.toml`; tutorials that start from an example
take it from `pericles new`. Needs Python with Matplotlib and Pillow. Takes about three minutes on two free cores, most of it for the Kalthoff-Winkler plate.
"""

import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PAGES = HERE / "src/tutorials"
LIMIT = 100_000  # bytes of a figure
K_IC = math.sqrt(8 * 72e9 / (1 - 0.25**2))  # Pa √m: the plates of the strength studies in plane strain


def decks(folder):
    """Writes the decks of the pages."""
    for page in PAGES.glob("*.md"):
        for name, body in re.findall(r"```toml,deck\n# (\S+\.toml)\n(.*?)```", page.read_text(), re.S):
            (folder / name).write_text(body)


def refresh():
    """Replaces every deck of the pages whose comments name an example (`pericles run examples/…`) by that example."""
    shown = re.compile(r"```toml,deck\n(?:#.*\n)*?#   pericles run +examples/(\S+)\n[\s\S]*?\n```")

    def present(block):
        return f"```toml,deck\n{(HERE.parent / 'examples' / block.group(1)).read_text().rstrip()}\n```"

    for page in HERE.glob("src/**/*.md"):
        text = page.read_text()
        replaced = shown.sub(present, text)
        if replaced != text:
            page.write_text(replaced)


def figure(source, name):
    """Copies a picture, with fewer pixels and colours if it is large."""
    target = PAGES / name
    shutil.copyfile(source, target)
    if target.stat().st_size > LIMIT:
        from PIL import Image

        picture = Image.open(source).convert("RGB")
        small = picture.resize((picture.width // 2, picture.height // 2), Image.LANCZOS)
        palette = small.quantize(255, method=Image.Quantize.MAXCOVERAGE)
        small.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(target, optimize=True)


def peak_stress(folder):
    """Largest nominal stress, MPa, of a plate of 40 mm width."""
    with open(folder / "force_displacement.csv") as table:
        return max(float(row["top_force_y [N/m]"]) for row in csv.DictReader(table)) / 0.04 / 1e6


def axes(plot, x, y):
    plot.set_xlabel(x)
    plot.set_ylabel(y)
    plot.set_ylim(bottom=0)
    plot.grid(color="0.9")


def strength_over_horizon(folder):
    import matplotlib.pyplot as plt

    chart, plot = plt.subplots(figsize=(6, 3.6), layout="constrained")
    spacings = [2, 1, 0.5]
    horizons = [3 * spacing for spacing in spacings]
    smooth = [peak_stress(folder / f"smooth/spacing={spacing}_mm") for spacing in spacings]
    notched = [peak_stress(folder / f"notched/spacing={spacing}_mm") for spacing in spacings]
    fine = [1.4 + 0.05 * i for i in range(100)]
    theory = [72e9 * 16 / 15 * math.sqrt(5 * math.pi * 8 / (12 * 72e9 * d * 1e-3)) / 1e6 for d in fine]
    plot.plot(fine, theory, "k--", lw=1, label="E′ s₀, proportional to δ^(−1/2)")
    plot.plot(horizons, smooth, "o", color="#0072b2", label="without notch")
    plot.plot(horizons, notched, "s", color="#d55e00", label="with notch")
    axes(plot, "horizon δ [mm]", "largest nominal stress [MPa]")
    plot.legend()
    chart.savefig(PAGES / "resolution-strength.png", dpi=130)


def strength_over_crack_length(folder):
    import matplotlib.pyplot as plt

    with open(folder / "griffith-sweep/summary.csv") as table:
        runs = [(row["run"], row["crack.0.segment"]) for row in csv.DictReader(table)]
    lengths = [float(re.search(r"'([\d.]+) mm'", segment).group(1)) for _, segment in runs]
    stresses = [peak_stress(folder / "griffith-sweep" / run) for run, _ in runs]
    fine = [0.7 + 0.1 * i for i in range(125)]
    theory = [K_IC / math.sqrt(math.pi * a * 1e-3 / math.cos(math.pi * a / 40)) / 1e6 for a in fine]
    chart, plot = plt.subplots(figsize=(6, 3.6), layout="constrained")
    plot.plot(fine, theory, "k--", lw=1, label="linear elastic fracture mechanics")
    plot.plot(lengths, stresses, "o", color="#0072b2", label="Pericles")
    axes(plot, "half crack length a [mm]", "largest nominal stress [MPa]")
    plot.legend()
    chart.savefig(PAGES / "sweep-strength.png", dpi=130)


def main():
    refresh()
    if "--decks" in sys.argv:
        return
    program = str(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent / "target/release/pericles").resolve())
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)

        def pericles(*words):
            print("pericles", *words, flush=True)
            subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)

        decks(folder)
        for example in ["fracture/mode-one", "impact/kalthoff-winkler", "absorbing/infinite-bar", "multi-time-step/inclusion"]:
            pericles("new", example)
        pericles("run", "mode-one.toml", "--quiet")
        pericles("run", "mode-one.toml", "--quiet", "--out", "fast", "--set", "constraint.0.velocity=['free', '1 m/s']", "--set", "constraint.1.velocity=['free', '-1 m/s']")
        pericles("plot", "mode-one", "--width", "800")
        pericles("plot", "fast", "--width", "800", "--field", "Damage", "--range=0:0.6")
        figure(folder / "mode-one/pictures/Damage-000003.png", "first-crack.png")
        figure(folder / "fast/plots/Damage-000006.png", "first-crack-fast.png")
        for table in ["history-energy", "cracks-length", "reactions-y"]:
            figure(folder / f"mode-one/plots/{table}.png", f"output-{table}.png")

        pericles("converge", "sine-bar.toml", "--m", "3", "--dx", "10 mm,5 mm,2.5 mm,1.25 mm", "--scalar", "audit.elastic_energy", "--reference", "0.04168643")
        figure(folder / "sine-bar-converge/convergence.png", "resolution-convergence.png")
        spacings = "body.spacing=2 mm,1 mm,0.5 mm"
        pericles("run", "notched-strip.toml", "--out", "notched", "--sweep", spacings)
        pericles("run", "notched-strip.toml", "--out", "smooth", "--sweep", spacings, "--set", "crack=[]")
        strength_over_horizon(folder)

        pericles("run", "kalthoff-winkler.toml", "--quiet")
        figure(folder / "kalthoff-winkler/pictures/Damage-000003.png", "kalthoff-winkler.png")

        pericles("run", "infinite-bar.toml", "--quiet")
        pericles("run", "infinite-bar.toml", "--quiet", "--out", "free-bar", "--set", "boundary=[]")
        for run, name in [("infinite-bar", "absorbing"), ("free-bar", "free")]:
            pericles("plot", run, "--history", "near_the_end_u_x", "--width", "800")
            figure(folder / run / "plots/probes-near_the_end_u_x.png", f"waves-probe-{name}.png")
        pericles("run", "damped-plate.toml", "--quiet")
        pericles("run", "damped-plate.toml", "--quiet", "--out", "free-plate", "--set", "boundary=[]")
        for run, name in [("damped-plate", "damped"), ("free-plate", "free")]:
            pericles("plot", run, "--field", "Velocity_x", "--time", "40 us", "--range=-0.06:0.06", "--width", "800")
            figure(folder / run / "plots/Velocity_x-000002.png", f"waves-plate-{name}.png")

        pericles("run", "pulled-sphere.toml", "--quiet")
        pericles("plot", "pulled-sphere", "--history", "stretch", "--width", "800")
        figure(folder / "pulled-sphere/pictures/Displacement-000001.png", "surface-sphere.png")
        figure(folder / "pulled-sphere/plots/surface-stretch.png", "surface-stretch.png")

        pericles("run", "inclusion.toml", "--quiet")
        figure(folder / "inclusion/pictures/Velocity_x-000002.png", "multirate-inclusion.png")

        halves = ",".join(f"[['-{a} mm', 0], ['{a} mm', 0]]" for a in [2, 4, 6, 8, 10, 12])
        pericles("run", "griffith.toml", "--sweep", f"crack.0.segment={halves}")
        strength_over_crack_length(folder)
        peaks = {run.name: peak_stress(run) for run in folder.glob("griffith-sweep/*/")}
        print(json.dumps(peaks, indent=1))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Writes book/src/verification.md, a summary of one page, and a page per topic in book/src/verification/ with all numbers of the studies as a build computes them.

    book/verification.py [PROGRAM] [SECONDS]

PROGRAM is the release build (default target/release/pericles), SECONDS the time limit of a study (default 600). Studies that exceed it are listed as not run. Comparisons with experiments run with --full. Rows that fail are on the summary,
all judged rows, and comparisons with measurements, on the pages of the topics; wall times are left out, so that the pages change only with the results. The exit status is 1 if a row fails or a study was not run. A new topic needs
an entry in TITLES and in src/SUMMARY.md.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent
PAGES = HERE / "src/verification"
TITLES = {
    "absorbing-boundaries": "Absorbing boundaries",
    "contact": "Contact",
    "dispersion": "Dispersion",
    "fracture": "Fracture",
    "heat": "Heat conduction",
    "manifolds": "Manifolds",
    "multi-time-step": "Multirate time integration",
    "nonlocal-wave": "The nonlocal wave equation",
    "numerics": "Numerical methods",
    "state-based": "State-based materials",
    "statics": "Static equilibrium",
    "validation": "Experiments",
}
STUDIES = "| study | content | source | rows | pass |\n|---|---|---|---|---|\n"
BOUNDS = {"upper bound": "at most", "lower bound": "at least"}
COLUMNS = "| case | printed | expected | computed | tolerance | |\n|---|---|---|---|---|---|\n"


def number(value):
    if value is None:
        return "–"
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.5g}"
    return f"{value:.3e}"


def interval(pair):
    return " to ".join(number(value) for value in pair)


def row(entry):
    note, tolerance = entry["note"], entry["tolerance"]
    if "measured" in entry:
        case = entry["case"] + (f" ({note})" if note else "")
        computed = number(entry["computed"]) + (f" ({interval(entry['spread'])})" if entry["spread"] else "")
        return f"| {case} | – | {interval(entry['measured'])} | {computed} | measured | {entry['agreement']} |\n"
    if tolerance is None:
        bound, _, note = note.partition("; ")
        allowed = BOUNDS[bound]
    else:
        allowed = "± " + (number(tolerance) if entry["absolute"] else f"{100 * tolerance:.3g} %")
    case = entry["case"] + (f" ({note})" if note else "")
    verdict = "pass" if entry["pass"] else "**fails**"
    cells = [case, number(entry["printed"]), number(entry["expected"]), number(entry["computed"]), allowed, verdict]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def parted(text):
    """Title and source of `title (source)`; both may contain parentheses."""
    depth = 0
    for place in range(len(text) - 1, -1, -1):
        depth += {")": 1, "(": -1}.get(text[place], 0)
        if depth == 0:
            return text[:place].strip(), text[place + 1 : -1]
    return text, ""


class Study:
    """A study as listed, with its results; none if it took too long."""

    def __init__(self, line):
        self.name, rest = line.split(None, 1)
        self.topic = self.name.split("/")[0]
        self.title, self.paper = parted(rest.strip())
        self.results, self.seconds = None, 0.0

    def run(self, program, limit, folder):
        out = pathlib.Path(folder) / "rows.json"
        command = [program, "reproduce", self.name, "--quiet", "--json", str(out), "--out", str(pathlib.Path(folder) / self.name.replace("/", "-"))]
        if self.topic == "validation":
            command.append("--full")
        began = time.monotonic()
        try:
            subprocess.run(command, timeout=limit, stdout=subprocess.DEVNULL, check=False)
            self.results = json.loads(out.read_text())
            out.unlink()
        except subprocess.TimeoutExpired:
            pass
        self.seconds = time.monotonic() - began

    @property
    def judged(self):
        rows = self.results["rows"] if self.results else []
        return [entry for entry in rows if entry["pass"] is not None]

    @property
    def shown(self):
        rows = self.results["rows"] if self.results else []
        return [entry for entry in rows if entry["pass"] is not None or "measured" in entry]

    @property
    def failing(self):
        return [entry for entry in self.judged if not entry["pass"]]

    def summary(self):
        name = f"[{self.name}](#{self.name.replace('/', '')})"
        if self.results is None:
            return f"| {name} | {self.title} | | | not run: time limit |\n"
        held = len(self.judged) - len(self.failing)
        return f"| {name} | {self.title} | {self.paper} | {len(self.judged)} | {held} |\n"


def title(topic):
    return TITLES.get(topic, topic.replace("-", " ").capitalize())


def topic_page(topic, studies):
    text = f"# {title(topic)}\n\n[Summary](../verification.md) of all topics. SI units. *Printed* is the number in the paper.\n\n"
    text += STUDIES + "".join(study.summary() for study in studies)
    for study in studies:
        text += f"\n## {study.name}\n\n{study.title} ({study.paper}).\n\n"
        if study.results is None:
            text += "Not run: the study exceeds the time limit.\n"
            continue
        text += COLUMNS + "".join(map(row, study.shown))
    (PAGES / f"{topic}.md").write_text(text)


def topic_row(topic, studies):
    """A row of the summary."""
    judged, failing = sum(len(study.judged) for study in studies), sum(len(study.failing) for study in studies)
    papers = "; ".join(dict.fromkeys(study.paper for study in studies if study.paper))
    return f"| [{title(topic)}](verification/{topic}.md) | {papers} | {len(studies)} | {judged} | {judged - failing} |\n"


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target/release/pericles")
    limit = float(sys.argv[2]) if len(sys.argv) > 2 else 600
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    listing = subprocess.run([program, "reproduce", "--list"], capture_output=True, text=True, check=True).stdout
    studies = [Study(line) for line in listing.splitlines()]
    with tempfile.TemporaryDirectory() as folder:
        for study in studies:
            study.run(program, limit, folder)
            print(f"{study.name}: {len(study.failing)} of {len(study.judged)} fail, {study.seconds:.1f} s", flush=True)
    PAGES.mkdir(exist_ok=True)
    topics = list(dict.fromkeys(study.topic for study in studies))
    for topic in topics:
        topic_page(topic, [study for study in studies if study.topic == topic])
    done = [study for study in studies if study.results is not None]
    judged, failing = sum(len(study.judged) for study in done), sum(len(study.failing) for study in done)
    text = (HERE / "verification-head.md").read_text()
    text += f"\n## Results\n\n{judged - failing} of {judged} comparisons in {len(done)} studies pass, computed by {version}.\n\n"
    text += "| topic | source | studies | comparisons | pass |\n|---|---|---|---|---|\n"
    text += "".join(topic_row(topic, [study for study in studies if study.topic == topic]) for topic in topics)
    if failing:
        text += "\nComparisons that do not pass:\n\n" + COLUMNS
        text += "".join(row({**entry, "case": f"{study.name}: {entry['case']}"}) for study in done for entry in study.failing)
    (HERE / "src/verification.md").write_text(text)
    return int(failing > 0 or len(done) < len(studies))


sys.exit(main())

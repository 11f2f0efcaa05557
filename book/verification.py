#!/usr/bin/env python3
"""Writes book/src/verification.md: what is tested, how, and the numbers of every study as this build computes them.

    book/verification.py [PROGRAM] [SECONDS]

PROGRAM is the release build (default target/release/pericles), SECONDS the longest a study may take (default 600). Studies that take longer are named as such.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent


def number(value):
    if value is None:
        return "–"
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.5g}"
    return f"{value:.3e}"


def row(entry):
    verdict = {True: "holds", False: "**fails**", None: ""}[entry["pass"]]
    tolerance = ""
    if entry["tolerance"] is not None:
        tolerance = "± " + (number(entry["tolerance"]) if entry["absolute"] else f"{100 * entry['tolerance']:.3g} %")
    note = f" ({entry['note']})" if entry["note"] else ""
    cells = [entry["case"] + note, number(entry["printed"]), number(entry["expected"]), number(entry["computed"]), tolerance, verdict]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def study(program, name, seconds, folder):
    """A section, and how many rows are judged and hold; none if it took too long."""
    out = pathlib.Path(folder) / "rows.json"
    command = [program, "reproduce", name, "--quiet", "--json", str(out), "--out", str(pathlib.Path(folder) / name.replace("/", "-"))]
    try:
        subprocess.run(command, timeout=seconds, stdout=subprocess.DEVNULL, check=False)
    except subprocess.TimeoutExpired:
        return None
    results = json.loads(out.read_text())
    out.unlink()
    judged = [entry for entry in results["rows"] if entry["pass"] is not None]
    held = sum(entry["pass"] for entry in judged)
    head = f"### {name}\n\n{results['paper']}. {held} of {len(judged)} judged rows hold.\n\n"
    head += "| case | printed | expected | computed | tolerance | |\n|---|---|---|---|---|---|\n"
    return head + "\n".join(map(row, results["rows"])) + "\n", held, len(judged)


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target/release/pericles")
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    listing = subprocess.run([program, "reproduce", "--list"], capture_output=True, text=True, check=True).stdout
    names = [line.split()[0] for line in listing.splitlines()]
    sections, late, held, judged = [], [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            found = study(program, name, seconds, folder)
            if found is None:
                late.append(name)
                continue
            text, good, all_ = found
            sections.append(text)
            held, judged = held + good, judged + all_
            print(f"{name}: {good} of {all_}", flush=True)
    text = (HERE / "verification-head.md").read_text()
    text += f"\n## Studies\n\nComputed by {version}: {held} of {judged} judged rows of {len(sections)} studies hold. SI units. Rows without a tolerance are information.\n\n"
    text += "\n".join(sections)
    if late:
        text += f"\nNot computed here, because each takes more than {seconds:.0f} s: {', '.join(late)}.\n"
    (HERE / "src/verification.md").write_text(text)


main()

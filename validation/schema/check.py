#!/usr/bin/env python3
"""Validates decks against the schema of Pericles with an independent validator.

    pericles schema > schema.json; python3 validation/schema/check.py schema.json

Exit status 0 if all is well, 1 on any difference, 2 if the check could not be made. See README.md.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMPLETE = ROOT / "crates/pericles-deck/tests/complete.toml"

# Text of the complete deck, and an invalid replacement that the schema must reject.
WRONG = [
    ('dx = "0.25 mm"', 'dy = "0.25 mm"'),
    ('dx = "0.25 mm"', 'dx = "a quarter"'),
    ('shape = "plate"', 'shape = "plaet"'),
    ("m = 3", "m = true"),
    ("m = 3", 'm = "three"'),
    ("m = 3", "m = 3\nhorizon = 1"),
    ("m = 3", ""),
    ('E = "72 GPa"', 'E = "-72 GPa"'),
    ('E = "72 GPa"', "E = 1\nyoungs_modulus = 1"),
    ('rho = "2.44 g/cm3"\n', ""),
    ('[0.0, "free"]', '[0.0, "fre"]'),
    ('[0.0, "free"]', '[0.0, "free", 0, 0]'),
    ("every = 500", "every = 0"),
    ("every = 500", "every = 1.5"),
    ('segment = [["-50 mm", "20 mm"], ', "segment = ["),
    ('kind = "pulse"', 'kind = "puls"'),
    ("count_precut = true", "count_precut = 1"),
    ("union = [", "onion = ["),
    ('title = "Everything a plate can have"', "title = 1"),
    ("[checkpoint]", "[checkpiont]"),
]


def in_environment(folder):
    """Runs this script again inside a virtual environment that has the validator, created on first use."""
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.exists():
        print(f"creating a virtual environment in {folder}", file=sys.stderr)
        venv.create(folder, with_pip=True)
    if subprocess.run([python, "-c", "import jsonschema"], capture_output=True).returncode:
        if subprocess.run([python, "-m", "pip", "install", "--quiet", "jsonschema"]).returncode:
            sys.exit(2)
    environment = dict(os.environ, PERICLES_SCHEMA_CHECK="1")
    sys.exit(subprocess.run([python, __file__, *sys.argv[1:]], env=environment).returncode)


def decks():
    """All decks of the repository: TOML files with a body."""
    for folder in ["examples", "validation", "crates/pericles-deck/tests"]:
        for path in sorted((ROOT / folder).rglob("*.toml")):
            document = tomllib.loads(path.read_text())
            if "body" in document:
                yield path.relative_to(ROOT), document


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("schema", type=Path)
    parser.add_argument("--venv", type=Path, default=Path(tempfile.gettempdir()) / "pericles-schema-check")
    arguments = parser.parse_args()
    try:
        from jsonschema import Draft202012Validator
    except ImportError:
        if "PERICLES_SCHEMA_CHECK" in os.environ:
            sys.exit(2)
        in_environment(arguments.venv)

    schema = json.loads(arguments.schema.read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    differences = 0
    count = 0
    for path, document in decks():
        count += 1
        for error in validator.iter_errors(document):
            differences += 1
            print(f"{path}: {list(error.path)}: {error.message[:200]}")
    complete = COMPLETE.read_text()
    for right, wrong in WRONG:
        assert complete.count(right) == 1, right
        if validator.is_valid(tomllib.loads(complete.replace(right, wrong))):
            differences += 1
            print(f"the schema allows {wrong!r} in place of {right!r}")
    print(f"{count} decks and {len(WRONG)} wrong ones: {differences} differences")
    sys.exit(1 if differences else 0)


if __name__ == "__main__":
    main()

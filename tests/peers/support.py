"""Shared by the peers: one line per check, runs of the program, strict JSON."""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INPUT = ROOT / "input"


class Checks:
    """Counts what passes and what fails; every check prints one line."""

    def __init__(self):
        self.failed = 0

    def true(self, name, holds, seen=""):
        print(f"ok {name}" if holds else f"FAILED {name}: {seen}")
        self.failed += not holds
        return holds

    def close(self, name, values, expected, tolerance, absolute=0.0):
        """Every value within the relative or absolute tolerance of the expected one; the line shows the worst."""
        values, expected = list(values), list(expected)
        same = len(values) == len(expected) and all(v is not None and math.isfinite(v) for v in values)
        excess = [abs(v - e) / (tolerance * abs(e) + absolute) for v, e in zip(values, expected)] if same else [math.inf]
        worst = max(range(len(excess)), key=excess.__getitem__)
        text = f"{values[worst]!r} for {expected[worst]!r}" if same else f"{values} for {expected}"
        return self.true(f"{name} ({tolerance:g})" if tolerance else f"{name} ({absolute:g} absolute)", excess[worst] <= 1, text)

    def end(self):
        sys.exit(1 if self.failed else 0)


def no_constant(name):
    raise ValueError(f"{name} is no JSON")


def parse(text):
    """JSON as the standard has it: NaN and Infinity are errors."""
    return json.loads(text, parse_constant=no_constant)


def numbers(value):
    if isinstance(value, dict):
        for item in value.values():
            yield from numbers(item)
    elif isinstance(value, list):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield value


def rotid(*arguments):
    """Exit code, standard output, standard error."""
    done = subprocess.run([sys.argv[1], *map(str, arguments)], capture_output=True, text=True, timeout=1800)  # on a machine that others use as well
    return done.returncode, done.stdout, done.stderr


def result(command, deck, *options, expected=(0,)):
    """The JSON of a run that ends with one of the expected exit codes."""
    code, out, err = rotid(command, deck, "--json", "-", *options)
    if code not in expected:
        raise RuntimeError(f"rotid {command} {deck} {' '.join(options)}: exit code {code}\n{err}")
    return parse(out)


def temporary_folder():
    return tempfile.TemporaryDirectory(prefix="rotid-peers-")

#!/usr/bin/env python3
"""Three programs for one solid: bricks by CalculiX, the converged frequencies below, and rotid with MODEL=SOLID. One line a
check; ends with "N passed, N failed". Called from the root of the sources: tools/solid3d/check.py ROTID. Without ccx nothing is
checked, and the one line says so."""
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
import ccx
import deck as decks
import solid3d

# [Hz], of another program: solids of revolution, first circumferential harmonic, 8-node elements halved towards the steps, up to
# 39,489 unknowns, extrapolated; +- 0.02 %. Its meshes of the two steps gave 720.420, 719.886, 719.707 Hz for mode 1 with 2.5,
# 1.25, 0.6 mm at the steps; bricks of even size come from far above: 731.49, 726.63, 723.92 Hz with 965, 3,661, 13,409 nodes.
CONVERGED = {
    "tools/solid3d/two_step.inp": (719.6, 1260.65, 3255.0, 3913.8, 6008.5),
    "input/converged_rotor.inp": (396.09, 686.80, 1128.06, 1617.10, 2147.50, 2765.33),
    "input/converged_steel.inp": (463.28, 728.51, 1274.01, 1790.09, 2384.15, 3059.18),
    "input/converged_stack.inp": (630.63, 776.42, 1650.31, 2171.09, 2597.67, 3368.79),
}
CHANGE = 0.05   # %, by the last size of the bricks in their limit
BRICKS = 0.02   # %, of that limit beside the frequencies above: what these may be off themselves
ROTID = 0.04    # %, of rotid beside that limit: what its own limit may be off, 0.02 %, and what the bricks may be


class Checks:
    def __init__(self):
        self.passed = self.failed = 0

    def within(self, name, errors, largest):
        listed = " ".join(f"{error:+.4f}" for error in errors)
        self.count(max(map(abs, errors)) <= largest, f"{name} [%]: {listed} (within {largest})")

    def count(self, good, text):
        self.passed += good
        self.failed += not good
        print("ok" if good else "FAILED", text, flush=True)


def percent(values, expected):
    return [100 * (a / b - 1) for a, b in zip(values, expected, strict=True)]


def modes_of(program, path, count):
    """Frequencies by rotid, of the full model; None with the reason where it does not read the deck."""
    done = subprocess.run([program, "modes", path, "--quiet", "--json", "-"], capture_output=True, text=True)
    if done.returncode not in (0, 1) or not done.stdout:
        return None, done.stderr.strip()
    return [mode["full_hz"] for mode in json.loads(done.stdout)["modes"]][:count], ""


def processor_seconds():
    used = os.times()
    return used.children_user + used.children_system


class Finest:
    """What the last size of the bricks takes and finds: as `tell` of solid3d.solve."""

    def __init__(self):
        self.before = processor_seconds()

    def __call__(self, name, nodes, _, frequencies):
        now = processor_seconds()
        self.nodes, self.seconds, self.frequencies, self.before = nodes, now - self.before, frequencies, now


def tell_cost(program, path, limits, finest, found):
    """A ratio of processor times of one run, which decides nothing. A fit needs both moduli and its modes some eight times; the
    bricks are solved once."""
    for command, options in (("modes", ()), ("identify", ("--no-baseline",))):
        before = processor_seconds()
        done = subprocess.run(["nice", "-n", "19", program, command, path, "--quiet", *options], capture_output=True,
                              env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        if done.returncode not in (0, 1):
            continue
        seconds = processor_seconds() - before
        print(f"{path}: {finest.nodes} nodes of bricks, {max(map(abs, percent(finest.frequencies, limits))):.3f} % off, took "
              f"{finest.seconds:.1f} s of processor time; rotid {command}, {max(map(abs, percent(found, limits))):.3f} % off, {seconds:.2f} s: "
              f"{finest.seconds / seconds:.0f} times", flush=True)


def main():
    if not ccx.PROGRAM:
        print("skipped: ccx is not installed (Debian: calculix-ccx; tools/setup --developer)")
        return 0
    checks = Checks()
    for path, converged in CONVERGED.items():
        finest = Finest()
        limits, change = solid3d.solve(decks.read(path), len(converged), tell=finest)
        checks.within(f"{path}: change of the limit of the bricks by their last size", change, CHANGE)
        checks.within(f"{path}: bricks beside solids of revolution", percent(limits, converged), BRICKS)
        found, why = modes_of(sys.argv[1], path, len(converged))
        if found:
            checks.within(f"{path}: rotid beside the bricks", percent(found, limits), ROTID)
            tell_cost(sys.argv[1], path, limits, finest, found)
        else:
            checks.count(False, f"{path}: rotid modes: {why}")
    print(f"{checks.passed} passed, {checks.failed} failed")
    return checks.failed > 0


if __name__ == "__main__":
    sys.exit(main())

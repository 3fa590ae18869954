#!/usr/bin/env python3
"""The frequencies of hide.py beside those of another program: solids of revolution, first circumferential harmonic, 8-node elements
halved towards the steps, up to 39,489 unknowns, extrapolated; +- 0.02 %. One line a check; exit code 1 where one fails."""
import sys
from pathlib import Path

sys.dont_write_bytecode = True
import hide
from effects import Effects, parse

INPUT = Path(__file__).resolve().parents[2] / "input"
WITHIN = 0.02  # %
CONVERGED = (
    ("converged_rotor.inp", "", (396.09, 686.80, 1128.06, 1617.10, 2147.50, 2765.33)),
    ("converged_rotor.inp", "stiffness_local:depth=0.5,z=0.91,width=0.03", (386.41, 683.99, 1105.50, 1599.35, 2114.64, 2717.47)),
    ("converged_rotor.inp", "stiffness_gradient:group=core,slope=0.2", (392.57, 688.52, 1123.65, 1613.08, 2147.63, 2757.99)),
    ("converged_steel.inp", "", (463.28, 728.51, 1274.01, 1790.09, 2384.15, 3059.18)),
    ("converged_stack.inp", "", (630.63, 776.42, 1650.31, 2171.09, 2597.67, 3368.79)),
)


def main():
    failed = 0
    for name, effect, converged in CONVERGED:
        deck = hide.decks.read(INPUT / name)
        hz, _ = hide.solve(deck, Effects([parse(effect)] if effect else []), hide.evenly(deck, 24), len(converged))
        errors = [100 * (a / b - 1) for a, b in zip(hz, converged, strict=True)]
        good = max(map(abs, errors)) <= WITHIN
        failed += not good
        print("ok" if good else "FAILED", f"{name} {effect}".strip(), "beside another program [%]:", *(f"{e:+.4f}" for e in errors), flush=True)
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())

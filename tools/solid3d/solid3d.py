#!/usr/bin/env python3
"""The bending frequencies of the rotor of a deck as a solid of bricks, by CalculiX. Shares no code with src and no element with a
solid of revolution. Three sizes of the bricks at the steps, 4, 2 and 1 times the shortest, give a row each. A re-entrant corner
is singular: the error falls like that size to the power 1.089, so the limit follows from the last two. The last row is the change
of the limit by the last size."""
import argparse
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # no trace among the sources
import ccx
import deck as decks
import mesh as meshes

# stress at a right angle cut out of a body grows like r^(0.5445 - 1) (Williams 1952); errors of frequencies follow the energy
EXPONENT = 2 * 0.5445
LARGEST = 0.03  # m
CORNER = 0.0025  # m, the last of three sizes


def limit(coarse, fine):
    """Of frequencies of one mode at two sizes, one half of the other."""
    return fine - (coarse - fine) / (2**EXPONENT - 1)


def solve(deck, modes, largest=LARGEST, corner=CORNER, tell=None):
    """The limit [Hz] and what the last size has changed in it [%], both for each mode."""
    found, limits = [], []
    for size in (4 * corner, 2 * corner, corner):
        mesh, begin = meshes.make(deck, largest, size), time.monotonic()
        with tempfile.TemporaryDirectory(prefix="solid3d-") as folder:
            found.append(ccx.run(deck, mesh, modes, folder))
        if tell:
            tell(f"{1000 * size:g}", len(mesh.nodes), time.monotonic() - begin, found[-1])
        if len(found) > 1:
            limits.append([limit(a, b) for a, b in zip(*found[-2:])])
    return limits[-1], [100 * (new / old - 1) for old, new in zip(*limits[-2:])]


def tell(name, nodes, seconds, values):
    print(f"{name:>9} {nodes:>8} {seconds:>7.1f}" + "".join(f" {value:10.3f}" for value in values), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deck")
    parser.add_argument("--modes", type=int, default=6, help="elastic bending modes (6)")
    parser.add_argument("--corner", type=float, default=CORNER, help="shortest bricks at steps [m] (0.0025)")
    parser.add_argument("--largest", type=float, default=LARGEST, help="longest bricks [m] (0.03)")
    parser.add_argument("--input", metavar="FILE", help="write the input for ccx and run nothing")
    options = parser.parse_args()
    try:
        deck = decks.read(options.deck)
        if options.input:
            with open(options.input, "w", encoding="ascii") as stream:
                stream.write(ccx.text_of(deck, meshes.make(deck, options.largest, options.corner), options.modes + 2))
            return 0
        if not ccx.PROGRAM:
            raise RuntimeError("ccx is not installed (Debian: calculix-ccx)")
        print("corner mm    nodes       s  frequencies [Hz]")
        limits, change = solve(deck, options.modes, options.largest, options.corner, tell)
        print(f"{'limit':>26}" + "".join(f" {value:10.3f}" for value in limits))
        print(f"{'change %':>26}" + "".join(f" {value:10.4f}" for value in change))
    except (OSError, ValueError, RuntimeError, decks.DeckError) as error:
        print(f"solid3d: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

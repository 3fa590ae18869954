#!/usr/bin/env python3
"""The bending frequencies of the rotor of a deck as a solid of bricks, by CalculiX. Shares no code with src and no element with a solid
of revolution. Each size of the bricks at the steps gives a row; a re-entrant corner is singular, so the error falls like that size to the
power 1.089, and the limit follows from the last two sizes. The last row is what the last size has changed in the limit."""
import argparse
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # no trace among the sources
import ccx
import deck as decks
import mesh as meshes

EXPONENT = 2 * 0.5445  # stress at a right angle cut out of a body grows like r^(0.5445 - 1) (Williams 1952); frequencies follow the energy
LARGEST = 0.04  # m
CORNERS = (0.01, 0.005, 0.0025)  # m


def limit(coarse, fine):
    """Of frequencies of one mode at two sizes, one half of the other."""
    return fine - (coarse - fine) / (2**EXPONENT - 1)


def solve(deck, modes, largest=LARGEST, corners=CORNERS, tell=None):
    """The limit [Hz] and what the last size has changed in it [%], both for each mode."""
    found, limits = [], []
    for corner in corners:
        mesh, begin = meshes.make(deck, largest, corner), time.monotonic()
        with tempfile.TemporaryDirectory(prefix="solid3d-") as folder:
            found.append(ccx.run(deck, mesh, modes, folder))
        if tell:
            tell(f"{1000 * corner:g}", len(mesh.nodes), time.monotonic() - begin, found[-1])
        if len(found) > 1:
            limits.append([limit(a, b) for a, b in zip(*found[-2:])])
    return limits[-1], [100 * (new / old - 1) for old, new in zip(*limits[-2:])]


def tell(name, nodes, seconds, values):
    print(f"{name:>9} {nodes:>8} {seconds:>7.1f}" + "".join(f" {value:10.3f}" for value in values), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deck")
    parser.add_argument("--modes", type=int, default=6, help="elastic bending modes (6)")
    parser.add_argument("--corner", type=float, default=CORNERS[-1], help="shortest bricks at steps [m] (0.0025); twice and four times that before")
    parser.add_argument("--largest", type=float, default=LARGEST, help="longest bricks [m] (0.04)")
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
        limits, change = solve(deck, options.modes, options.largest, [4 * options.corner, 2 * options.corner, options.corner], tell)
        print(f"{'limit':>26}" + "".join(f" {value:10.3f}" for value in limits))
        print(f"{'change %':>26}" + "".join(f" {value:10.4f}" for value in change))
    except (OSError, ValueError, RuntimeError, decks.DeckError) as error:
        print(f"solid3d: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

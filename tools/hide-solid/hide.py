#!/usr/bin/env python3
"""Modes of the rotor of a deck as a solid of revolution, by elements of high order, with effects hidden in them, noise added, as a
deck with these measured data and the truth as JSON. Shares no code and no element with src. The deck's own moduli are the truth;
a fit starts where its *IDENTIFY says."""
import argparse
import json
import os
import sys
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # matrices of one element: threads would only wait for each other
sys.dont_write_bytecode = True  # no trace among the sources
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "solid3d"))
import deck as decks
import effects as hidden
import numpy as np
from meridian import Meridian

DATA = ("SENSORS", "MODES", "SHAPE", "MEASURED", "NOISE", "FREQUENCIES")
NOISE = (0.001, 0.015)  # of frequencies; of shapes, relative to the largest component


def solve(deck, effects, stated, modes):
    """Frequencies [Hz], and shapes (sensor, mode) with a largest component of 1."""
    body = Meridian(deck, effects)
    hz, vectors = body.modes(modes)
    shapes = np.array([[body.surface(v, z) for v in vectors.T] for z in effects.places(stated)])
    return hz, shapes / shapes[np.abs(shapes).argmax(axis=0), range(modes)]


def disturbed(hz, shapes, effects, noise, seed):
    """The same as measured: noise from a seed, then the faults of channels. Without a seed no noise."""
    hz, shapes = hz.copy(), shapes.copy()
    if seed is not None:
        random = np.random.default_rng(seed)
        hz *= 1 + noise[0] * random.standard_normal(hz.shape)
        shapes += noise[1] * random.standard_normal(shapes.shape)
    effects.disturb(shapes)
    return hz, shapes


def text_of(lines, stated, hz, shapes, noise):
    """The deck `lines` with these data in place of its own."""
    out, skip = [], False
    for line in lines:
        if line.startswith("*") and not line.startswith("**"):
            skip = line[1:].split(",")[0].strip().upper() in DATA
        if not skip:
            out.append(line)
    out += ["*SENSORS"] + [f"{i}, {z:.9g}" for i, z in enumerate(stated, 1)]
    out += ["*MODES"] + [f"{k}, {f:.9g}" for k, f in enumerate(hz, 1)]
    for k, shape in enumerate(shapes.T, 1):
        out += [f"*SHAPE, MODE={k}"] + [f"{i}, {u:.9g}" for i, u in enumerate(shape, 1)]
    return "\n".join(out + [f"*NOISE, FREQUENCY={noise[0]:g}, SHAPE={noise[1]:g}", ""])


def truth_of(path, deck, effects, stated, hz, noise, seed):
    return {"deck": str(path), "seed": seed, "length": deck.length, "noise": noise, "frequency_hz": list(hz), "sensors": list(stated),
            "effects": [{"id": e.id, "target": e.target, **e.value} for e in effects.all],
            "moduli": {f"{name}.{key}": value for s in deck.sections for name, ring in zip(s.names, s.rings)
                       for key, value in (("E", deck.materials[ring[2]].axial_e), ("G", deck.materials[ring[2]].axial_g))}}


def evenly(deck, count):
    return [deck.length * i / (count - 1) for i in range(count)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deck")
    parser.add_argument("-o", "--output", metavar="DECK", help="without it the exact frequencies are printed")
    parser.add_argument("--truth", metavar="FILE")
    parser.add_argument("--effect", action="append", default=[], metavar="ID:KEY=VALUE,...", help="such as "
                        "stiffness_local:depth=0.5,z=0.91,width=0.03, density:group=core,factor=1.1, joint:between=left+core,"
                        "flexibility=1e-9, sensor_swap:sensor=7,other=9")
    parser.add_argument("--sensors", type=int, default=68, help="evenly from end to end (68)")
    parser.add_argument("--modes", type=int, default=6)
    parser.add_argument("--noise", default="0.001,0.015", help="of frequencies, of shapes (0.001,0.015)")
    parser.add_argument("--seed", type=int, default=1, help="of the noise (1)")
    options = parser.parse_args()
    try:
        deck = decks.read(options.deck)
        effects = hidden.Effects([hidden.parse(text) for text in options.effect])
        stated, noise = evenly(deck, options.sensors), tuple(float(x) for x in options.noise.split(","))
        hz, shapes = solve(deck, effects, stated, options.modes)
        if not options.output:
            print(*(f"{f:.3f}" for f in hz))
            return 0
        lines = Path(options.deck).read_text(encoding="utf-8").splitlines()
        Path(options.output).write_text(text_of(lines, stated, *disturbed(hz, shapes, effects, noise, options.seed), noise),
                                        encoding="utf-8")
        if options.truth:
            Path(options.truth).write_text(json.dumps(truth_of(options.deck, deck, effects, stated, hz, noise, options.seed), indent=2))
    except (OSError, ValueError, KeyError, decks.DeckError) as error:
        print(f"hide-solid: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

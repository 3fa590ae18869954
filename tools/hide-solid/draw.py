"""Rotors and effects at random. Ranges: core or stack 0.20 to 0.42 m thick and 1.6 to 2.4 times as long; two or three steel sections
to each side, each 1.15 to 1.5 times thinner than the one before; every other rotor is a stack on a through shaft; E 0.6 to
1.4e11 Pa, E/G 2 to 3.2; 24 to 68 sensors evenly from end to end; six modes."""
import math

import effects as hidden

KINDS = ("none", "stiffness_local", "added_mass", "stiffness", "sensor_sign", "pair", "density", "stiffness_gradient",
         "stiffness_profile", "joint", "none", "pair", "sensor_gain", "stiffness_local", "added_mass", "density", "stiffness",
         "stiffness_gradient", "sensor_position", "none", "joint", "pair", "stiffness_profile", "sensor_swap", "stiffness_local",
         "density", "duplicate_channel", "stiffness", "added_mass", "pair")
PAIRS = (("stiffness_local", "density"), ("stiffness_gradient", "added_mass"), ("stiffness", "added_mass"), ("joint", "density"),
         ("added_mass", "stiffness_local"), ("stiffness_gradient", "stiffness"))


def end(random, thick):
    """Lengths and diameters of one side, from the core outwards."""
    found, d = [], thick
    for _ in range(random.integers(2, 4)):
        d /= random.uniform(1.15, 1.5)
        found.append((thick * random.uniform(0.45, 0.95), d))
    return found


def rotor(random, layered):
    """The text of a deck whose moduli are the truth, and the name of the group whose moduli are identified."""
    thick, e = random.uniform(0.20, 0.42), random.uniform(0.6e11, 1.4e11)
    seat = thick * random.uniform(0.35, 0.5) if layered else thick
    length, name = thick * random.uniform(1.6, 2.4), "stack" if layered else "core"
    sides = {"left": end(random, seat * 1.15 if layered else thick)[::-1], "core": [(length, seat)],
             "right": end(random, seat * 1.15 if layered else thick)}
    out = ["*HEADING", "Stepped rotor drawn at random", "*MATERIAL, NAME=steel", "*ELASTIC", "2.1e11, 0.3", "*DENSITY", "7850",
           "*MATERIAL, NAME=sheets", "*ELASTIC, TYPE=LAMINATED",
           f"{e:.4g}, {e / random.uniform(2, 3.2):.4g}, {random.uniform(1.9e11, 2.1e11):.3g}, 0.29",
           "*DENSITY", f"{random.uniform(7500, 7700):.0f}"]
    for group, sections in sides.items():
        out.append(f"*SHAFT, NAME={group}, MATERIAL={'steel' if layered or group != 'core' else 'sheets'}")
        out += [f"{a:.4f}, {d:.4f}, 0, {math.ceil(a / 0.02)}" for a, d in sections]
    if layered:
        out += ["*LAYER, NAME=stack, GROUP=core, MATERIAL=sheets", f"{thick:.4f}, {seat:.4f}"]
    out += ["*SPRING", f"start, {random.uniform(2e3, 1e4):.0f}", f"end, {random.uniform(2e3, 1e4):.0f}", "*FIT, MODEL=SOLID",
            "*IDENTIFY", f"{name}.E, 1e9, 2.3e11, 0.8e11", f"{name}.G, 1e9, 0.9e11, 0.3e11"]
    return out, name


def mass_of(deck):
    return sum(math.pi * (b**2 - a**2) * s.length * deck.materials[m].rho for s in deck.sections for a, b, m in s.rings)


def effect(random, kind, deck, name, sensors):
    """One effect of this kind, of a size that may or may not show."""
    def sign():
        return random.choice((-1, 1))

    side = str(random.choice(("left", "right")))
    at = {"sensor": int(random.integers(3, sensors - 2))}
    if kind == "stiffness_local":
        from_, to = hidden.span(deck, name)
        return hidden.Effect(kind, "", {"depth": random.uniform(0.35, 0.7), "z": from_ + (to - from_) * random.uniform(0.15, 0.85),
                                        "width": deck.length * random.uniform(0.015, 0.04)})
    if kind == "stiffness_gradient":
        return hidden.Effect(kind, name, {"slope": sign() * random.uniform(0.15, 0.4)})
    if kind == "stiffness_profile":
        return hidden.Effect(kind, name, {"profile": sign() * random.uniform(0.3, 0.7)})
    if kind == "added_mass":
        return hidden.Effect(kind, "", {"mass": mass_of(deck) * random.uniform(0.008, 0.025), "z": deck.length * random.uniform(0.03, 0.97)})
    if kind == "stiffness":
        return hidden.Effect(kind, side, {"factor": 1 + sign() * random.uniform(0.05, 0.15)})
    if kind == "density":
        return hidden.Effect(kind, side, {"factor": 1 + sign() * random.uniform(0.03, 0.12)})
    if kind == "joint":
        between = str(random.choice(("left,core", "core,right")))
        thinner = min((hidden.section_at(deck, hidden.span(deck, "core")[i] + d) for i, d in ((between == "core,right", s)
                      for s in (-0.001, 0.001))), key=hidden.second_moment)
        thick = 2 * thinner.rings[-1][1]
        return hidden.Effect(kind, between, {"flexibility": random.uniform(0.1, 0.5) * thick / (2.1e11 * hidden.second_moment(thinner))})
    if kind == "sensor_gain":
        return hidden.Effect(kind, "", {**at, "gain": random.choice((random.uniform(0.6, 0.8), random.uniform(1.25, 1.5)))})
    if kind == "sensor_position":
        return hidden.Effect(kind, "", {**at, "shift": sign() * deck.length * random.uniform(0.02, 0.04)})
    if kind in ("sensor_swap", "duplicate_channel"):
        return hidden.Effect(kind, "", {**at, "other": at["sensor"] + int(random.integers(1, 3))})
    return hidden.Effect(kind, "", at)

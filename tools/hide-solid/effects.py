"""What is hidden: effects in the body (fields over z, rings of mass) and in the channels. Written from docs/deck.md alone."""
import math
from dataclasses import dataclass, field

STRIP = 0.01  # m, of the surface under a mass: a line of mass would sink in without limit
SLICE = 0.002  # m: all of the flexibility of a joint
CHANNEL = ("sensor_gain", "sensor_sign", "sensor_swap", "sensor_position", "duplicate_channel")
BODY = ("stiffness_local", "stiffness_gradient", "stiffness_profile", "added_mass", "stiffness", "density", "joint")


@dataclass
class Effect:
    id: str
    target: str = ""  # a group; of a joint "left,core"
    value: dict = field(default_factory=dict)


def parse(text):
    """ID:key=value,...; group=NAME or between=LEFT+RIGHT is the target."""
    name, _, rest = text.partition(":")
    effect = Effect(name)
    if name not in CHANNEL + BODY:
        raise ValueError(f"effect {name}: not one of {', '.join(BODY + CHANNEL)}")
    for part in filter(None, rest.split(",")):
        key, _, value = part.partition("=")
        if key in ("group", "between"):
            effect.target = value.lower().replace("+", ",")
        else:
            effect.value[key] = float(value)
    return effect


def span(deck, group):
    inside = [s for s in deck.sections if group in s.names]
    if not inside:
        raise ValueError(f"there is no group {group}")
    return inside[0].z, inside[-1].z + inside[-1].length


def section_at(deck, z):
    return next((s for s in deck.sections if z < s.z + s.length), deck.sections[-1])


def second_moment(section):
    return math.pi / 4 * sum(outer**4 - inner**4 for inner, outer, _ in section.rings)


@dataclass
class Effects:
    all: list = field(default_factory=list)

    def joints(self, deck):
        """(from, to, I c over the length): the slice on the thinner side of the interface."""
        for e in (e for e in self.all if e.id == "joint"):
            z = span(deck, e.target.split(",")[0])[1]
            left, right = section_at(deck, z - SLICE), section_at(deck, z + SLICE)
            thinner = left if second_moment(left) <= second_moment(right) else right
            from_ = z - SLICE if thinner is left else z
            yield from_, from_ + SLICE, e.value["flexibility"] * second_moment(thinner) / SLICE

    def strips(self, deck):
        """(mass, from, to), inside of one section."""
        for e in (e for e in self.all if e.id == "added_mass"):
            section = section_at(deck, e.value["z"])
            from_ = min(max(e.value["z"] - STRIP / 2, section.z), section.z + section.length - STRIP)
            yield e.value["mass"], from_, from_ + STRIP

    def lines(self, deck):
        """Where elements have to end."""
        found = [z for a, b, _ in self.joints(deck) for z in (a, b)] + [z for _, a, b in self.strips(deck) for z in (a, b)]
        for e in (e for e in self.all if e.id == "stiffness_local"):
            found += [e.value["z"] + e.value["width"] * i for i in (-2, -1, 0, 1, 2)]
        return [z for z in found if 0 < z < deck.length]

    def field(self, deck, section, ring, z):
        """Factors on E, G and density at z of one ring, and the compliance of a joint [1/Pa]."""
        e, rho, joint = 1.0, 1.0, 0.0
        for effect in self.all:
            value = effect.value
            if effect.id == "stiffness_local":
                e *= 1 - value["depth"] * math.exp(-((z - value["z"]) / value["width"])**2 / 2)
            elif effect.target == section.names[ring]:
                from_, to = span(deck, effect.target)
                xi = (2 * z - from_ - to) / (to - from_)
                e *= {"stiffness_gradient": lambda: 1 + value["slope"] * xi, "stiffness": lambda: value["factor"],
                      "stiffness_profile": lambda: 1 + value["profile"] * (xi**2 - 1 / 3)}.get(effect.id, lambda: 1)()
                rho *= value["factor"] if effect.id == "density" else 1
        for from_, to, of_slice in self.joints(deck):
            joint += of_slice if from_ < z < to else 0
        return e, e, rho, joint

    def places(self, stated):
        """Where the sensors, numbered from 1, really are."""
        z = list(stated)
        for e in (e for e in self.all if e.id == "sensor_position"):
            z[int(e.value["sensor"]) - 1] += e.value["shift"]
        return z

    def disturb(self, shapes):
        """Faults of channels, in shapes (sensor, mode) with their noise."""
        for e in self.all:
            i, other = (int(e.value.get(key, 0)) - 1 for key in ("sensor", "other"))
            if e.id == "sensor_gain":
                shapes[i] *= e.value["gain"]
            elif e.id == "sensor_sign":
                shapes[i] *= -1
            elif e.id == "sensor_swap":
                shapes[[i, other]] = shapes[[other, i]]
            elif e.id == "duplicate_channel":
                shapes[i] = shapes[other]

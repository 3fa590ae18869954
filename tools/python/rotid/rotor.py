"""A rotor of another program on its way to a deck: what lies along the axis, what is attached, the deck, and its reading back."""
import json
import math
import os
import tempfile
import warnings
from dataclasses import dataclass, field

from .program import Message, RotidError, call, said

CONE_STEPS = 8  # cylinders that stand for a cone
TOUCH = 1e-9  # relative: as layers of a deck
SHEAR_NU = 0.3  # Poisson's ratio of the shear coefficient where E and G give none
NEAR = 1e-8  # relative: rotid check states lengths with nine digits


@dataclass(frozen=True)
class Material:
    name: str
    e: float  # Pa
    g: float
    rho: float  # kg/m3
    nu: float = None  # of TYPE=SHEAR; None: isotropic

    @staticmethod
    def of(name, e, g, rho, notes):
        """E and G that no isotropic material has are TYPE=SHEAR: a stack of sheets."""
        nu = e / (2 * g) - 1
        if -1 < nu <= 0.5:
            return Material(name, e, g, rho)
        notes.setdefault(f"material {name}: E {e:g} Pa and G {g:g} Pa are those of no isotropic material (Poisson's ratio would be {nu:.3g}), "
                         f"taken as TYPE=SHEAR; the shear coefficient is that of Poisson's ratio {SHEAR_NU}")
        return Material(name, e, g, rho, SHEAR_NU)


@dataclass
class Ring:
    """Of one element: diameters [m] at the left and the right end."""

    inner: tuple
    outer: tuple
    material: Material
    where: str

    @property
    def is_cone(self):
        return not near(*self.outer) or (not near(*self.inner) and max(self.inner) > 0)


@dataclass
class Station:
    """One element of the axis: rings from the axis outwards, of one length [m]; axial force [N], tension positive."""

    length: float
    rings: list
    force: float = 0.0


@dataclass
class Part:
    """A disk, or a spring to the ground, at a place [m] from the left end."""

    name: str
    z: float
    mass: float = 0.0
    diametral: float = 0.0
    polar: float = 0.0
    lateral: float = 0.0
    rotational: float = 0.0


@dataclass
class Rotor:
    heading: str
    source: str
    stations: list
    disks: list = field(default_factory=list)
    springs: list = field(default_factory=list)
    notes: dict = field(default_factory=dict)  # what of the source is not in the rotor; an ordered set

    def write(self, path, program=None):
        return write_deck(self, path, program)


def near(a, b, tolerance=TOUCH):
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


def refuse(source, where, text):
    raise RotidError([Message(f"{where}: {text}" if where else text, file=str(source))])


def usable(name):
    """A name of a deck: printable ASCII without what cards are made of."""
    plain = ""
    for c in str(name)[:63]:
        if "!" <= c <= "~" and c not in ",*=.:\"'":
            plain += c
        elif plain and not plain.endswith("_"):
            plain += "_"
    return plain or "part"


class Names:
    """Names that are not taken yet, without regard to case; what was tried before is not tried again."""

    def __init__(self):
        self.taken, self.next = set(), {}

    def __call__(self, wanted):
        base = usable(wanted)
        name, key = base, base.lower()
        while name.lower() in self.taken:
            self.next[key] = self.next.get(key, 1) + 1
            name = f"{base}_{self.next[key]}"
        self.taken.add(name.lower())
        return name


def check_station(source, station):
    first = station.rings[0]
    for before, ring in zip(station.rings, station.rings[1:]):
        if ring.is_cone or first.is_cone:
            refuse(source, ring.where, "cones that lie around each other have no deck, expected cylinders")
        if not near(ring.inner[0], before.outer[0]):
            refuse(source, ring.where, f"its inner diameter is {ring.inner[0]:g} m, expected {before.outer[0]:g} m, the outer one of what it lies "
                   "around")


def sections_of(station):
    """(length, elements, rings as (outer, inner)) of a station: a cone as cylinders."""
    ring = station.rings[0]
    if not ring.is_cone:
        return [[station.length, 1, [(r.outer[0], r.inner[0]) for r in station.rings]]]
    places = [(i + 0.5) / CONE_STEPS for i in range(CONE_STEPS)]
    return [[station.length / CONE_STEPS, 1, [tuple((1 - t) * end[0] + t * end[1] for end in (ring.outer, ring.inner))]] for t in places]


def groups_of(rotor):
    """Neighbours of the same materials and force, and their sections: equal elements are one section."""
    groups = []
    for station in rotor.stations:
        check_station(rotor.source, station)
        key = ([ring.material for ring in station.rings], station.force)
        if not groups or groups[-1][0] != key:
            groups.append((key, []))
        sections = groups[-1][1]
        for length, elements, rings in sections_of(station):
            last = sections[-1] if sections else None
            if last and near(last[0] / last[1], length) and last[2] == rings:
                last[0] += length
                last[1] += elements
            else:
                sections.append([length, elements, rings])
    return groups


def number(value):
    return repr(float(value)) if value else "0"


def row(*values):
    return ", ".join(v if isinstance(v, str) else number(v) for v in values) + "\n"


def deck_of(rotor):
    """The text, and what rotid check is to find in it."""
    names, cards, meant = Names(), [], {"groups": [], "disks": [], "springs": []}
    cards.append(f"*HEADING\n{heading_of(rotor.heading)}\n")
    layers, of_materials, known = [], Names(), {}
    for (materials, force), sections in groups_of(rotor):
        own = None
        for i, material in enumerate(materials):
            name = names(material.name)
            own = own or name
            if material not in known:
                known[material] = of_materials(material.name)
                cards.append(material_cards(known[material], material))
            if i:
                rows = "".join(row(rings[i][0], rings[i][1]) for _, _, rings in sections)
                cards.append(f"*LAYER, NAME={name}, GROUP={own}, MATERIAL={known[material]}\n{rows}")
                layers.append(group_meant(name, own, material, sections, i, 0.0))
                continue
            rows = "".join(row(length, rings[0][0], rings[0][1], str(elements)) for length, elements, rings in sections)
            cards.append(f"*SHAFT, NAME={name}, MATERIAL={known[material]}\n{rows}")
            meant["groups"].append(group_meant(name, None, material, sections, 0, force))
        if force:
            cards.append(f"*PRELOAD, GROUP={own}\n{row(force)}")
    meant["groups"] += layers
    length = sum(station.length for station in rotor.stations)
    for part in rotor.disks:
        name = names(part.name)
        cards.append(f"*DISK, NAME={name}\n{row(place(part.z, length), part.mass, part.diametral, part.polar)}")
        meant["disks"].append({"name": name, "z_m": part.z, "mass_kg": part.mass, "diametral_kg_m2": part.diametral, "polar_kg_m2": part.polar})
    for part in rotor.springs:
        name = names(part.name)
        cards.append(f"*SPRING, NAME={name}\n{row(place(part.z, length), part.lateral, part.rotational)}")
        meant["springs"].append({"name": name, "z_m": part.z, "lateral_n_m": part.lateral, "rotational_nm_rad": part.rotational})
    return "".join(cards), meant


def heading_of(text):
    """One line that is no card and no comment."""
    return "".join(c if " " <= c <= "~" else "?" for c in text).strip().lstrip("*") or "rotor"


def place(z, length):
    return "start" if z == 0 else "end" if near(z, length) else number(z)


def material_cards(name, material):
    isotropic = material.nu is None
    elastic = row(material.e, material.e / (2 * material.g) - 1) if isotropic else row(material.e, material.g, material.nu)
    return f"*MATERIAL, NAME={name}\n*ELASTIC{'' if isotropic else ', TYPE=SHEAR'}\n{elastic}*DENSITY\n{row(material.rho)}"


def group_meant(name, layer_of, material, sections, ring, force):
    return {"name": name, "layer_of": layer_of, "preload_n": force,
            "material": {"e_pa": material.e, "g_pa": material.g, "rho_kg_m3": material.rho},
            "segments": [{"length": length, "elements": elements, "outer_m": rings[ring][0], "inner_m": rings[ring][1]}
                         for length, elements, rings in sections]}


def same(meant, found):
    if isinstance(meant, dict):
        return all(same(value, found.get(key)) for key, value in meant.items())
    if isinstance(meant, list):
        return len(meant) == len(found) and all(map(same, meant, found))
    return meant == found if isinstance(meant, str) or meant is None else found is not None and near(meant, found, NEAR)


def compare(meant, geometry):
    """The kind and the name of the first part that was read as another one, or None."""
    for group in geometry["groups"]:
        group.setdefault("layer_of", None)
        for segment in group["segments"]:
            segment["length"] = segment["to_m"] - segment["from_m"]
    for kind, items in meant.items():
        found = geometry[kind]
        if len(found) != len(items):
            return f"{kind}: {len(found)} instead of {len(items)}"
        for item, other in zip(items, found):
            length = geometry["length_m"]
            for a, b in zip(item.get("segments", ()), other.get("segments", ())):
                if abs(a["length"] - b["length"]) <= NEAR * length:  # a difference of two places with nine digits
                    b["length"] = a["length"]
            if "z_m" in item and abs(item["z_m"] - other["z_m"]) <= NEAR * length:
                other["z_m"] = item["z_m"]
            if not same(item, other):
                return f"{kind}: {item['name']}"
    return None


def write_deck(rotor, path, program=None):
    """Writes the rotor as a deck. The deck is read back by `rotid check` and compared with what was meant before it is in place: whole
    or not there. What of the source is not in the deck is warned of, and what `rotid check` warns of. RotidError where the rotor has no
    deck; returns the path."""
    text, meant = deck_of(rotor)
    path = os.fspath(path)
    temporary = None
    try:
        with tempfile.NamedTemporaryFile("w", dir=os.path.dirname(path) or ".", prefix=os.path.basename(path) + ".", suffix=".inp", delete=False,
                                         encoding="ascii") as stream:
            temporary = stream.name
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        doubtful = read_back(rotor, temporary, meant, program)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, path)
        temporary = None
    except OSError as error:
        raise RotidError([f"cannot write {path}: {error.strerror or error}"], 3) from None
    finally:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
    for note in [*rotor.notes, *doubtful]:
        warnings.warn(str(Message(note, "note", str(rotor.source))), stacklevel=2)
    return path


def read_back(rotor, deck, meant, program):
    code, out, err = call(program, "check", deck, "--json", "-")
    if code or not out.strip():
        raise RotidError([Message(f"as a deck: {m.text}", file=str(rotor.source)) for m in said(err) if m.severity == "error"]
                         or [f"rotid check ended with exit code {code}"], code or 3)
    wrong = compare(meant, json.loads(out)["geometry"])
    if wrong:
        refuse(rotor.source, None, f"the deck was read back and is another rotor ({wrong}), expected what was meant: nothing was written")
    return [f"as a deck: {m.text}" for m in said(err) if m.severity == "warning"]


def finite(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)

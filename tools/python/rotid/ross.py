"""Rotors of ROSS as decks, and rotors of rotid as ross.Rotor. Reading a saved rotor needs no ROSS."""
import csv
import json
import math
import os
import tempfile
import warnings
from pathlib import Path

import numpy as np

from .program import RotidError, run
from .rotor import Material, Part, Ring, Rotor, Station, near, refuse

MOST_NODES = 10000  # as elements of a deck
LOST = {
    "torque": "torque is left out: it does not act on bending at rest here",
    "shear_effects": "elements without shear_effects get them: every element of rotid has them",
    "rotary_inertia": "elements without rotary_inertia get it: every element of rotid has it",
    "shear_method_calc": "shear coefficients are Cowper's, not those of shear_method_calc",
    "damping": "damping is left out",
    "speeds": "of bearings with values at several speeds the first one is taken",
    "kyy": "kyy is not kxx: kxx is taken, for bending in the plane x",
    "my": "my of a PointMass is not mx: mx is taken, for bending in the plane x",
    "cross": "cross coupling (kxy, kyx) is left out",
    "mass": "added masses of bearings (mxx) are left out",
    "support": "masses on supports of bearings are left out",
}


class Object:
    """An object of the file with its key: numbers by name, refused with file and place."""

    def __init__(self, source, key, values):
        self.source, self.key, self.values = source, key, values

    def wrong(self, name, text):
        refuse(self.source, f"{self.key}.{name}" if name else self.key, text)

    def shown(self, value):
        return {None: "null", True: "true", False: "false"}.get(value) if value is None or isinstance(value, bool) else \
            "a list" if isinstance(value, list) else "an object" if isinstance(value, dict) else f"the text {value[:40]!r}" \
            if isinstance(value, str) else f"{value:g}"

    def number(self, name, least=-math.inf, above=False, default=None):
        """`default` where the key is missing; null is no number."""
        if name not in self.values and default is not None:
            return default
        value = self.values.get(name)
        expected = "a number" + (f" {'above' if above else 'not below'} {least:g}" if least > -math.inf else "")
        if name not in self.values:
            self.wrong(name, f"is missing, expected {expected}")
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or value < least or (above and value == least):
            self.wrong(name, f"is {self.shown(value)}, expected {expected}")
        return float(value)

    def node(self, name):
        value = self.number(name)
        if value != math.floor(value) or not 0 <= value <= MOST_NODES:
            self.wrong(name, f"is {value:g}, expected the number of a node from 0 to {MOST_NODES}")
        return int(value)

    def first(self, name, default=None, least=-math.inf):
        """The first of a list over the speeds, all of which are numbers, or the number itself; and whether there are others. A key that
        is missing or null is what ROSS has for it."""
        value = self.values.get(name)
        if value is None and default is not None and name not in ("kxx",):
            return default, False
        items = value if isinstance(value, list) else [value]
        if not items:
            self.wrong(name, "is an empty list, expected a stiffness for each speed")
        for item in items:
            if isinstance(item, bool) or not isinstance(item, (int, float)) or not math.isfinite(item) or item < least:
                self.wrong(name, f"{'has ' if isinstance(value, list) else 'is '}{self.shown(item) if name in self.values else 'missing'}, expected a "
                                 f"number{'' if least == -math.inf else f' not below {least:g}'} or a list of them")
        return float(items[0]), any(item != items[0] for item in items)

    def text(self, name, default):
        value = self.values.get(name)
        return value if isinstance(value, str) and value else default

    def flag(self, name):
        return self.values.get(name) is not False


def no_constant(text):
    raise ValueError(f"{text} is no JSON")


def integer(text):
    """An integer beyond all doubles is infinite, as 1e999 is, and refused with its place where a number is expected."""
    return int(text) if len(text) < 300 else float(text)


def unique(pairs):
    keys = dict(pairs)
    if len(keys) < len(pairs):
        twice = next(k for i, (k, _) in enumerate(pairs) if k in dict(pairs[:i]))
        raise ValueError(f"the key {twice[:60]!r} occurs twice in an object")
    return keys


def load(path):
    try:
        root = json.loads(Path(path).read_bytes().decode("utf-8"), parse_constant=no_constant, parse_int=integer, object_pairs_hook=unique)
    except OSError as error:
        refuse(path, None, f"cannot be read: {error.strerror or error}")
    except json.JSONDecodeError as error:
        refuse(path, f"line {error.lineno}, column {error.colno}", f"{error.msg}, expected JSON as Rotor.save writes it")
    except (ValueError, RecursionError) as error:
        refuse(path, None, f"{error}, expected JSON as Rotor.save writes it")
    if not isinstance(root, dict) or not isinstance(root.get("parameters"), dict):
        refuse(path, None, "is no rotor of ROSS, expected what Rotor.save writes into a file .json")
    return root


def from_ross(source):
    """A ross.Rotor, or the path of one that Rotor.save has written, as a Rotor: bending in the plane x at rest. RotidError with the
    place in the JSON where it has no deck."""
    if hasattr(source, "save") and hasattr(source, "shaft_elements"):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "rotor.json")
            source.save(path)
            return of_saved("a ross.Rotor", load(path))
    return of_saved(source, load(source))


def of_saved(source, root):
    elements, disks, bearings, notes, materials = [], [], [], {}, {}

    def lose(what, item):
        notes.setdefault(LOST[what], None)
        first.setdefault(LOST[what], item.key)

    first = {}
    for key, values in root.items():
        if key == "parameters" or not isinstance(values, dict):
            continue
        item = Object(source, key, values)
        kind = key.split("_")[0]
        if kind == "ShaftElement":
            elements.append(shaft_element(item, lose, materials, notes))
        elif kind == "PointMass":
            name = "m" if values.get("mx") is None else "mx"
            disks.append((item, item.node("n"), item.number(name, 0), 0.0, 0.0))
            if item.values.get("my") is not None and item.number("my", 0) != disks[-1][2]:
                lose("my", item)
        elif "kxx" in values or "n_link" in values:
            bearings.append(bearing(item, lose))
        elif "Id" in values and "m" in values:
            disks.append((item, item.node("n"), item.number("m", 0), item.number("Id", 0), item.number("Ip", 0, default=0.0)))
        else:
            item.wrong(None, "is no part that rotid knows, expected a ShaftElement, a disk, a bearing or a PointMass of ROSS")
    if not elements:
        refuse(source, None, "has no ShaftElement, expected at least one")
    version = root.get("ross_version")
    name = os.path.basename(str(source))
    rotor = Rotor(f"Rotor of ROSS {version if isinstance(version, str) else '(unknown version)'}, bending in its plane x, from {name}", str(source), [])
    first_node, z = stations_of(source, elements, rotor)
    last_node = first_node + len(z) - 1
    supports = {b[2] for b in bearings if b[2] is not None}
    for item, node, mass, diametral, polar in disks:
        if first_node <= node <= last_node:
            rotor.disks.append(Part(item.text("tag", "disk"), z[node - first_node], mass, diametral, polar))
        elif node in supports:
            lose("support", item)
        else:
            item.wrong("n", f"is {node}, expected a node of the shaft, {first_node} to {last_node}, or of a support")
    rotor.springs = springs_of(bearings, first_node, last_node, z)
    rotor.notes = {(f"{first[note]}: {note}" if note in first else note): None for note in notes}
    return rotor


def shaft_element(item, lose, materials, notes):
    length = item.number("L", 0, above=True)
    inner = tuple(item.number(name, 0) for name in ("idl", "idr"))
    outer = tuple(item.number(name, 0, above=True) for name in ("odl", "odr"))
    for end, (i, o) in enumerate(zip(inner, outer)):
        if i >= o:
            item.wrong(("idl", "idr")[end], f"is {i:g} and the outer diameter {o:g}, expected the inner one below")
    values = item.values.get("material")
    if not isinstance(values, dict):
        item.wrong("material", f"is {item.shown(values)}, expected an object" if "material" in item.values else "is missing, expected an object")
    of = Object(item.source, f"{item.key}.material", values)
    key = (of.text("name", "material"), of.number("E", 0, above=True), of.number("G_s", 0, above=True), of.number("rho", 0, above=True))
    if key not in materials:
        materials[key] = Material.of(*key, notes)
    if item.number("torque", default=0.0):
        lose("torque", item)
    for flag in ("shear_effects", "rotary_inertia"):
        if not item.flag(flag):
            lose(flag, item)
    if item.text("shear_method_calc", "cowper") != "cowper":
        lose("shear_method_calc", item)
    if item.number("alpha", default=0.0) or item.number("beta", default=0.0):
        lose("damping", item)
    ring = Ring(inner, outer, materials[key], item.key)
    return item.node("n"), length, ring, item.number("axial_force", default=0.0), item


def bearing(item, lose):
    node = item.node("n")
    link = item.node("n_link") if item.values.get("n_link") is not None else None
    if "kxx" not in item.values:
        item.wrong("kxx", "is missing, expected its stiffness")
    kxx, several = item.first("kxx", least=0.0)
    if several:
        lose("speeds", item)
    kyy, _ = item.first("kyy", kxx)
    if kyy != kxx:
        lose("kyy", item)
    if item.first("kxy", 0.0)[0] or item.first("kyx", 0.0)[0]:
        lose("cross", item)
    if item.first("cxx", 0.0)[0] or item.first("cyy", 0.0)[0]:
        lose("damping", item)
    if item.first("mxx", 0.0)[0] or item.first("myy", 0.0)[0]:
        lose("mass", item)
    if link == node:
        item.wrong("n_link", f"is {link}, the node of the bearing, expected that of a support")
    return item, node, link, kxx


def stations_of(source, elements, rotor):
    """The stations of the shaft; its first node, and where its nodes are."""
    elements.sort(key=lambda e: (e[0], e[2].inner[0]))
    z = [0.0]
    first_node = elements[0][0]
    for node, length, ring, force, item in elements:
        at = node - first_node
        if at == len(z) - 2:  # around the one before
            station = rotor.stations[-1]
            if not near(length, station.length):
                item.wrong("L", f"is {length:g}, expected {station.length:g}, the length of what it lies around")
            station.rings.append(ring)
            station.force += force
        elif at == len(z) - 1:
            rotor.stations.append(Station(length, [ring], force))
            z.append(z[-1] + length)
        else:
            item.wrong("n", f"is {node}, and the elements leave a gap before it, expected one at every node up to it")
    return first_node, z


def springs_of(bearings, first_node, last_node, z):
    """What the shaft feels: the network of bearings and supports, of which the supports are eliminated one after the other (star to mesh:
    neighbours i and j get k_i k_j / sum k, without a difference of large numbers). What is left are springs from nodes of the shaft to the
    ground; a network that ties two nodes of the shaft to each other has no deck."""
    ground, neighbours, owner, linked = -1, {}, {}, {link for _, _, link, _ in bearings}

    def join(a, b, stiffness):
        for one, other in ((a, b), (b, a)):
            if one != ground:
                near_by = neighbours.setdefault(one, {})
                near_by[other] = near_by.get(other, 0.0) + stiffness

    def is_shaft(node):
        return first_node <= node <= last_node

    for item, node, link, stiffness in bearings:
        if not is_shaft(node) and node not in linked:
            item.wrong("n", f"is {node}, expected a node of the shaft, {first_node} to {last_node}, or a support that a bearing stands on")
        if is_shaft(node):
            owner.setdefault(node, item)
        if stiffness > 0:
            join(node, ground if link is None else link, stiffness)
    for node in sorted(n for n in neighbours if not is_shaft(n)):
        star = neighbours.pop(node)
        total = sum(star.values())
        ends = sorted(star)
        for i, a in enumerate(ends):
            neighbours.get(a, {}).pop(node, None)
            for b in ends[i + 1:]:
                join(a, b, star[a] / total * star[b])
    springs = []
    for node in sorted(n for n in neighbours if is_shaft(n)):
        item = owner.get(node)
        others = [n for n in neighbours[node] if n != ground]
        if others:
            (item or owner[others[0]]).wrong("n_link", f"joins the nodes {node} and {others[0]} of the shaft, directly or by a support, expected a "
                                                       "support of its own for each, for a deck has springs to the ground alone")
        if ground in neighbours[node]:  # else on a support that nothing holds
            springs.append(Part(item.text("tag", "bearing"), z[node - first_node], lateral=neighbours[node][ground]))
    return springs


# ---- to ROSS


def to_ross(deck, start=False, program=None, **options):
    """The model of a deck as a ross.Rotor: fitted first where the deck has *IDENTIFY and measured modes, or with start=True as the deck
    states it. Elements of the axis are ShaftElements whose diameters, E, G_s and rho give the EI, kGS, rhoS and rhoI of rotid; springs
    are bearings with kxx = kyy, disks disks. What ROSS has no element for (tie rods, bars, joints, masses between nodes, springs on
    rotations) is one further element with the matrices of rotid, and a warning names the places. Bending in both planes is that of
    rotid in the measured one; the matrices are compared before the rotor is returned."""
    model = exported(deck, start, program, options)
    shaft, disks, springs, rest = parts_of(model)
    rotor = built(model, shaft, disks, springs, rest)
    compare(model, rotor)
    return rotor


def exported(deck, start, program, options):
    """K and M of the axis as dense matrices in x and dx/dz = -theta, inner nodes of rods and bars condensed; geometry; notes."""
    from scipy.io import mmread

    with tempfile.TemporaryDirectory() as folder:
        base = os.path.join(folder, "model")
        out = run("export", deck, program=program, format="matrix-market", output=base, start=start, **options)
        k, m = (np.asarray(mmread(f"{base}.{name}.mtx").todense(), dtype=float) for name in ("stiffness", "mass"))
        with open(f"{base}.nodes.csv", encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
    if "row_u" in rows[0]:
        raise RotidError([f"{deck}: is a solid, and ROSS has beam elements, expected one with MODEL=BEAM (set={{'FIT.MODEL': 'BEAM'}})"])
    sign = np.tile([1.0, -1.0], len(rows))
    k, m = sign[:, None] * k * sign, sign[:, None] * m * sign
    axis = [i for i, row in enumerate(rows) if row["member"] == "axis"]
    inner = [i for i, row in enumerate(rows) if row["member"] != "axis"]
    notes = []
    on, off = dofs(axis), dofs(inner)
    if inner:
        t = -np.linalg.solve(k[np.ix_(off, off)], k[np.ix_(off, on)])
        m = m[np.ix_(on, on)] + m[np.ix_(on, off)] @ t + (m[np.ix_(on, off)] @ t).T + t.T @ m[np.ix_(off, off)] @ t
        k = k[np.ix_(on, on)] + k[np.ix_(on, off)] @ t
        k = (k + k.T) / 2
        names = ", ".join(sorted({rows[i]["member"] for i in inner}))
        notes.append(f"{names}: what lies between the nodes of the axis is condensed, and modes of these parts themselves are missing")
    of_state = ("--set", f"FIT.STATE={options['state']}") if options.get("state") else ()
    geometry = run("check", deck, *of_state, program=program, **{name: value for name, value in options.items() if name == "set"})["geometry"]
    return {"deck": str(deck), "k": k, "m": m, "z": np.array([float(rows[i]["z_m"]) for i in axis]), "geometry": geometry, "notes": notes, "out": out}


def dofs(nodes):
    return [2 * node + c for node in nodes for c in (0, 1)]


def beam_stiffness(length, ei, phi, force):
    """K of a Timoshenko element in x and dx/dz, with the geometric stiffness of an axial force, tension positive."""
    a, b, c, d = 12.0, 6 * length, (4 + phi) * length**2, (2 - phi) * length**2
    k = ei / (length**3 * (1 + phi)) * np.array([[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]])
    p, q, r, s = 36 + 60 * phi + 30 * phi**2, 3 * length, (4 + 5 * phi + 2.5 * phi**2) * length**2, -(1 + 5 * phi + 2.5 * phi**2) * length**2
    g = np.array([[p, q, -p, q], [q, r, -q, s], [-p, -q, p, -q], [q, s, -q, r]])
    return k + force / (30 * length * (1 + phi) ** 2) * g


def beam_mass(length, phi):
    """The coefficients of rhoS and rhoI in M of that element."""
    l, f = length, 1 / (1 + phi) ** 2
    a, b = 13 / 35 + 7 * phi / 10 + phi**2 / 3, (11 / 210 + 11 * phi / 120 + phi**2 / 24) * l
    c, d = 9 / 70 + 3 * phi / 10 + phi**2 / 6, -(13 / 420 + 3 * phi / 40 + phi**2 / 24) * l
    e, g = (1 / 105 + phi / 60 + phi**2 / 120) * l**2, -(1 / 140 + phi / 60 + phi**2 / 120) * l**2
    area = l * f * np.array([[a, b, c, d], [b, e, -d, g], [c, -d, a, -b], [d, g, -b, e]])
    h, i = 6 / 5, (1 / 10 - phi / 2) * l
    j, n = (2 / 15 + phi / 6 + phi**2 / 3) * l**2, (-1 / 30 - phi / 6 + phi**2 / 6) * l**2
    return area, f / l * np.array([[h, i, -h, i], [i, j, -i, n], [-h, -i, h, -i], [i, n, -i, j]])


def identified(length, k, m):
    """EI, phi, axial force, rhoS, rhoI of the element whose K and M have these blocks between its nodes [2, 2], and how well. The moments
    of a rotation hold 2 b12 + b11 L = -P whatever EI and phi are; then b11 and b22 give EI and phi."""
    force = -(k[0, 1] - k[1, 0] + k[0, 0] * length)
    phi, ei = 0.0, 1.0
    for _ in range(50):
        g = beam_stiffness(length, 0.0, phi, force)
        first, second = k[0, 0] - g[0, 2], k[1, 1] - g[1, 3]  # -12 c and (2 - phi) c L^2, c = EI/(L^3 (1 + phi))
        was, phi = phi, 2 + 12 * second / (first * length**2)
        ei = -first / 12 * length**3 * (1 + phi)
        if abs(phi - was) <= 1e-15 * max(1, abs(phi)):
            break
    if not (phi > -1e-9 and ei > 0):
        return None
    phi = max(phi, 0.0)
    area, rotary = beam_mass(length, phi)
    rhos, rhoi = np.linalg.solve([[area[0, 2], rotary[0, 2]], [area[1, 3], rotary[1, 3]]], [m[0, 0], m[1, 1]])
    if not (rhos > 0 and rhoi > 0):
        return None
    stiff = np.abs(beam_stiffness(length, ei, phi, force)[:2, 2:] - k) / np.abs(k).max()
    heavy = np.abs((rhos * area + rhoi * rotary)[:2, 2:] - m) / np.abs(m).max()
    return (ei, phi, force, rhos, rhoi) if stiff.max() < 1e-9 and heavy.max() < 1e-9 else None


def segment_at(geometry, z):
    """The group and the section of the axis at a place, its rings outside among them: outer diameter, height of a rectangle."""
    outer, where = 0.0, None
    for group in geometry["groups"]:
        for segment in group["segments"]:
            if segment["from_m"] <= z <= segment["to_m"]:
                outer = max(outer, segment.get("outer_m") or segment["height_m"])
                where = where or (group, segment)
    return outer, *where


def round_section(outer, ei, kgs, rhos, rhoi):
    """Diameters, E, G_s, rho of a ShaftElement: rhoI/rhoS = (outer^2 + inner^2)/16, and G_s by Cowper's shear coefficient at the Poisson's
    ratio E/(2 G_s) - 1 that ROSS derives, so that nothing is lost when ROSS saves the rotor."""
    squares = 16 * rhoi / rhos
    inner2 = squares - outer**2
    if inner2 < 1e-9 * outer**2:
        outer, inner2 = (outer, 0.0) if abs(inner2) < 1e-9 * outer**2 else (math.sqrt(squares), 0.0)
    area = math.pi / 4 * (outer**2 - inner2)
    e = ei / (area * (outer**2 + inner2) / 16)
    a, b = (1 + inner2 / outer**2) ** 2, inner2 / outer**2
    below = 3 * a * e / (kgs / area) - a - 8 * b
    return (outer, math.sqrt(inner2), e, (3 * a + 6 * b) * e / below, rhos / area) if below > 0 else None


def parts_of(model, drawn=()):
    """Elements as (length, outer, inner, E, G_s, rho, force, group, section), disks, springs, and K, M and polar inertia that are left.
    RotidError where stiffness of an element of a group of `drawn` is left, which would not be drawn."""
    z, geometry = model["z"], model["geometry"]
    k, m = model["k"].copy(), model["m"].copy()
    shaft, last = [], None
    for i in range(len(z) - 1):
        length, at = z[i + 1] - z[i], slice(2 * i, 2 * i + 4)
        outer, group, segment = segment_at(geometry, (z[i] + z[i + 1]) / 2)
        found = identified(length, model["k"][2 * i:2 * i + 2, 2 * i + 2:2 * i + 4], model["m"][2 * i:2 * i + 2, 2 * i + 2:2 * i + 4])
        section = found and round_section(outer, found[0], 12 * found[0] / (max(found[1], 1e-12) * length**2), found[3], found[4])
        if not section:  # a joint, a mass or a spring lies in it: as its neighbour or its card; what differs is left for the rest
            section, found = last and last[0] == id(segment) and last[1] or stated(group, segment, outer), None
        section = (*section, found[2] if found else 0.0)
        last = (id(segment), section[:5])
        outer, inner, e, g, rho, force = section
        area, inertia = math.pi / 4 * (outer**2 - inner**2), math.pi / 64 * (outer**4 - inner**4)
        phi = 12 * e * inertia / (cowper(e / (2 * g) - 1, inner / outer) * g * area * length**2)
        mass = beam_mass(length, phi)
        bent = beam_stiffness(length, e * inertia, phi, force)
        if group["name"] in drawn and np.abs(bent - model["k"][at, at])[:2, 2:].max() > 1e-6 * np.abs(bent).max():
            raise RotidError([f"{model['deck']}: {group['name']} has no element of ROSS from z = {z[i]:g} to {z[i + 1]:g} m, expected a ratio of E and "
                              "G nearer to that of an isotropic material, and nothing in that element but its section: the rest would not be drawn"])
        k[at, at] -= bent
        m[at, at] -= rho * area * mass[0] + rho * inertia * mass[1]
        shaft.append((length, *section, group, segment))
    disks, springs = [], []
    for disk in geometry["disks"]:
        node = node_at(z, disk["z_m"])
        disks.append((node, disk))
        m[2 * node, 2 * node] -= disk["mass_kg"]
        m[2 * node + 1, 2 * node + 1] -= disk["diametral_kg_m2"]
    for spring in geometry["springs"]:
        node = node_at(z, spring["z_m"])
        if spring["lateral_n_m"] > 0:
            springs.append((node, spring))
            k[2 * node, 2 * node] -= spring["lateral_n_m"]
    for part, matrix in ((k, model["k"]), (m, model["m"])):
        scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
        part[np.abs(part) <= 1e-11 * scale] = 0.0
    return shaft, disks, springs, (k, m, polar_of_rods(model))


def cowper(nu, ratio):
    a, b = (1 + ratio**2) ** 2, ratio**2
    return 6 * a * (1 + nu) / (a * (7 + 6 * nu) + b * (20 + 12 * nu))


def stated(group, segment, outer):
    material = group["material"]
    inner = segment.get("inner_m") or 0.0
    return outer, inner, material["e_pa"], material["g_pa"], material["rho_kg_m3"]


def node_at(z, place):
    """The mesh has a node at every part, or one so near that the part is there."""
    return int(np.argmin(np.abs(z - place)))


def built(model, shaft, disks, springs, rest):
    import ross

    class Given(ross.DiskElement):
        """Matrices of rotid over some nodes, the same in both planes."""

        def __init__(self, nodes, stiffness, mass, polar, tag):
            self.of, self.stiffness, self.mass, self.gyroscopic = nodes, planes(stiffness), planes(mass), between_planes(polar)
            lateral, tilt = np.tile([1.0, 0.0], len(nodes)), np.column_stack((model["z"][nodes], np.ones(len(nodes)))).ravel()
            moved = float(lateral @ mass @ lateral)
            centre = float(tilt @ mass @ lateral) / moved if moved > 0 else model["z"][nodes[0]]
            super().__init__(n=int(np.argmin(np.abs(model["z"] - centre))), m=0.0, Id=0.0, Ip=0.0, tag=tag)
            self.m = max(moved, 0.0)  # for the mass that ROSS states; its matrices are those above

        @property
        def dof_global_index(self):
            return self._index

        @dof_global_index.setter
        def dof_global_index(self, index):
            self._index = {f"{name}_{node}": 6 * node + c for node in self.of for c, name in PLANES} if index else None

        def K(self, *_, **__):
            return self.stiffness

        def M(self, *_, **__):
            return self.mass

        def G(self, *_, **__):
            return self.gyroscopic

        def C(self, *_, **__):
            return np.zeros_like(self.mass)

        Kdt = C

    elements, materials = [], {}
    for n, (length, outer, inner, e, g, rho, force, group, _) in enumerate(shaft):
        key = (e, g, rho)
        if key not in materials:
            materials[key] = ross.Material(f"{group['name']}_{len(materials)}".replace(" ", "_"), rho=rho, E=e, G_s=g)
        elements.append(ross.ShaftElement(L=length, idl=inner, odl=outer, material=materials[key], n=n, axial_force=force))
    parts = [ross.DiskElement(n=n, m=d["mass_kg"], Id=d["diametral_kg_m2"], Ip=d["polar_kg_m2"], tag=d["name"] or f"disk {i}")
             for i, (n, d) in enumerate(disks)]
    supports = [ross.BearingElement(n=n, kxx=s["lateral_n_m"], cxx=0, tag=f"{s['name'] or 'spring'} {i}") for i, (n, s) in enumerate(springs)]
    used = np.flatnonzero(sum((part != 0).any(axis=0) for part in rest))
    nodes = sorted({int(i) // 2 for i in used})
    if nodes:
        at = dofs(nodes)
        parts.append(Given(nodes, *(part[np.ix_(at, at)] for part in rest), "of rotid"))
        places = ", ".join(f"{model['z'][n]:.6g}" for n in nodes[:8]) + (" and more" if len(nodes) > 8 else "")
        model["notes"].append(f"ROSS has no element for what acts between or on the nodes at z = {places} m besides shaft, disks and springs (tie "
                              "rods, bars, joints, masses between nodes, springs on rotations): one element has the matrices of rotid; a rotor "
                              "that ROSS saves has it not")
    if any("height_m" in s and s.get("height_m") for g in model["geometry"]["groups"] for s in g["segments"]):
        model["notes"].append("the beam is rectangular: the rotor bends as the beam does in the measured plane at rest")
    for note in model["notes"]:
        warnings.warn(f"{model['deck']}: {note}", stacklevel=4)
    return ross.Rotor(elements, parts, supports)


def polar_of_rods(model):
    """Polar inertia of tie rods and bars in x and dx/dz: twice their rotary inertia as rotid has it, that of bars at their centre."""
    z, polar = model["z"], np.zeros_like(model["m"])
    for part in model["geometry"]["tierods"]:
        material, length, ends = part["material"], part["to_m"] - part["from_m"], [node_at(z, part["from_m"]), node_at(z, part["to_m"])]
        area, own, ring = section_of_rods(part)
        inertia = own + ring if part["model"] == "TUBE" else own
        outer2, inner2 = (8 * inertia / area + sign * 2 * area / math.pi for sign in (1, -1))
        ratio = math.sqrt(inner2 / outer2) if part["model"] == "TUBE" else 0.0
        phi = 12 * material["e_pa"] * inertia / (cowper(material["nu"], ratio) * material["g_pa"] * area * length**2)
        polar[np.ix_(dofs(ends), dofs(ends))] += 2 * material["rho_kg_m3"] * inertia * beam_mass(length, phi)[1]
        if part["model"] == "RODS":  # they move along themselves as the ends tilt
            turns = [2 * node + 1 for node in ends]
            polar[np.ix_(turns, turns)] += material["rho_kg_m3"] * ring * length / 3 * np.array([[2.0, 1.0], [1.0, 2.0]])
    for part in model["geometry"]["bars"]:
        turn = 2 * node_at(z, part["center_m"]) + 1
        _, own, ring = section_of_rods(part)
        polar[turn, turn] += 2 * part["material"]["rho_kg_m3"] * (own + ring) * (part["to_m"] - part["from_m"])
    return polar


def section_of_rods(part):
    """Area, second moment of the rods about their own axes, and that of their areas about a diameter of the pitch circle."""
    area = part["number"] * math.pi / 4 * part["diameter_m"] ** 2
    return area, area * part["diameter_m"] ** 2 / 16, area * part["pitch_radius_m"] ** 2 / 2


PLANES = ((0, "x"), (4, "beta"), (1, "y"), (3, "alpha"))  # alpha = -dy/dz


def of_planes(n):
    """Zeros for n nodes in the order of PLANES, the places of both planes there, and the signs of the second one."""
    places = [[4 * i + c for i in range(n) for c in part] for part in ((0, 1), (2, 3))]
    return np.zeros((4 * n, 4 * n)), *places, np.tile([1.0, -1.0], n)


def planes(matrix):
    """A matrix in x and dx/dz of some nodes in the order of PLANES for each of them, both planes."""
    full, first, second, sign = of_planes(len(matrix) // 2)
    full[np.ix_(first, first)] = matrix
    full[np.ix_(second, second)] = sign[:, None] * matrix * sign
    return full


def between_planes(polar):
    """The gyroscopic matrix of a polar inertia in x and dx/dz of some nodes, in the order of PLANES."""
    full, first, second, sign = of_planes(len(polar) // 2)
    full[np.ix_(first, second)] = polar * sign
    full[np.ix_(second, first)] = -sign[:, None] * polar
    return full


def compare(model, rotor):
    """ROSS has the matrices of rotid in both planes, or the rotor is not returned."""
    for c, turn, sign in ((0, 4, 1.0), (1, 3, -1.0)):
        at = [6 * i + part for i in range(len(model["z"])) for part in (c, turn)]
        signs = np.tile([1.0, sign], len(model["z"]))
        for name, found, meant in (("K", rotor.K(0), model["k"]), ("M", rotor.M(0), model["m"])):
            error = np.abs(signs[:, None] * found[np.ix_(at, at)] * signs - meant) / np.sqrt(np.outer(np.diag(meant), np.diag(meant)))
            if not error.max() < 1e-9:
                i, j = np.unravel_index(error.argmax(), error.shape)
                raise RotidError([f"{model['deck']}: {name} of the ross.Rotor is another one than that of rotid, {error.max():.1e} between z = "
                                  f"{model['z'][i // 2]:g} and {model['z'][j // 2]:g} m, expected the same"], 3)

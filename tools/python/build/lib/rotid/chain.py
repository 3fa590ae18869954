"""Beam elements between nodes in space, as Nastran and Abaqus have them, as stations along an axis."""
from dataclasses import dataclass

import numpy as np

from .program import Message, RotidError
from .rotor import Part, Ring, Rotor, Station, refuse

STRAIGHT = 1e-6  # of the length of the rotor: nodes may lie so far from its axis

# what a length, modulus, density, mass and stiffness of the file are times these in SI
UNITS = {"SI": {"length": 1.0, "modulus": 1.0, "density": 1.0, "mass": 1.0},
         "MM": {"length": 1e-3, "modulus": 1e6, "density": 1e12, "mass": 1e3}}


@dataclass
class Beam:
    ends: tuple  # nodes
    inner: tuple  # diameters at them
    outer: tuple
    material: object
    where: str


@dataclass
class Mass:
    node: int
    mass: float
    inertia: object  # [3, 3] about the node
    where: str


@dataclass
class Spring:
    node: int
    stiffness: float
    where: str


def units_of(units):
    if units not in UNITS:
        raise RotidError([Message(f"units {units!r}: expected {' or '.join(UNITS)}")])
    return UNITS[units]


def in_si(value, factor):
    """value * factor to the fifteen digits that both have: 7.85e-9 t/mm3 are 7850 kg/m3 and not 7850.000000000001."""
    return float(f"{float(value) * factor:.15g}") if factor != 1 else float(value)


def rotor_of(source, heading, place, beams, masses, springs, notes):
    """place: node -> coordinates [m]. Elements side by side between the same nodes are rings around each other."""
    if not beams:
        refuse(source, None, "has no beam element, expected at least one")
    used = sorted({node for beam in beams for node in beam.ends})
    x = np.array([place[node] for node in used])
    start = x[np.argmax(np.linalg.norm(x - x[0], axis=1))]
    end = x[np.argmax(np.linalg.norm(x - start, axis=1))]
    length = float(np.linalg.norm(end - start))
    if not length > 0:
        refuse(source, beams[0].where, "all nodes are at one place, expected them along a line")
    axis = (end - start) / length
    if axis[np.argmax(np.abs(axis))] < 0:  # from the left as the coordinate rises
        start, end, axis = end, start, -axis
    z = {node: float((place[node] - start) @ axis) for node in place}
    off = {node: float(np.linalg.norm(place[node] - start - z[node] * axis)) for node in place}
    for beam in beams:
        for node in beam.ends:
            if off[node] > STRAIGHT * length:
                refuse(source, beam.where, f"its node {node} lies {off[node]:.3g} m beside the axis, expected the nodes along a straight line")
    one_node_a_place(source, beams, z, length)
    rotor = Rotor(heading, str(source), stations(source, beams, z, length), notes=notes)
    for mass in masses:
        at = on_axis(source, mass, z, used, length)
        across = np.eye(3) - np.outer(axis, axis)
        polar = float(axis @ mass.inertia @ axis)
        rotor.disks.append(Part(mass.where, at, mass.mass, (float(np.trace(mass.inertia)) - polar) / 2, polar))
        uneven = across @ mass.inertia @ across - (np.trace(mass.inertia) - polar) / 2 * across
        if np.abs(uneven).max() > 1e-9 * max(np.abs(mass.inertia).max(), 1e-300):
            refuse(source, mass.where, "its inertias about two diameters differ, expected those of a disk")
    for spring in springs:
        rotor.springs.append(Part(spring.where, on_axis(source, spring, z, used, length), lateral=spring.stiffness))
    return rotor


def one_node_a_place(source, beams, z, length):
    """Two nodes at one place are two bodies there, whatever else may join them."""
    known = sorted({node: (z[node], node, beam.where) for beam in beams for node in beam.ends}.values())
    joined = {frozenset(beam.ends) for beam in beams}
    for (left, first, _), (right, second, where) in zip(known, known[1:]):
        if right - left <= STRAIGHT * length and frozenset((first, second)) not in joined:
            refuse(source, where, f"its node {second} lies where node {first} is, and they are not joined, expected one node")


def on_axis(source, part, z, used, length):
    if part.node not in z:
        refuse(source, part.where, f"node {part.node} is not there")
    if part.node not in used:
        refuse(source, part.where, f"node {part.node} belongs to no beam element, expected a node of the rotor")
    return min(max(z[part.node], 0.0), length)


def stations(source, beams, z, length):
    along = {}
    for beam in beams:
        a, b = beam.ends
        turned = z[a] > z[b]
        left, right = (b, a) if turned else (a, b)
        if not z[right] - z[left] > STRAIGHT * 1e-3 * length:
            refuse(source, beam.where, "it has no length, expected two places")
        ends = slice(None, None, -1) if turned else slice(None)
        along.setdefault((z[left], z[right]), []).append(Ring(beam.inner[ends], beam.outer[ends], beam.material, beam.where))
    found, at = [], 0.0
    for (left, right), rings in sorted(along.items()):
        if abs(left - at) > STRAIGHT * length:
            refuse(source, rings[0].where, f"it begins {left:g} m from the left end, and the elements before it end at {at:g} m, expected one behind "
                                           "the other")
        found.append(Station(right - left, sorted(rings, key=lambda ring: ring.inner[0])))
        at = right
    return found

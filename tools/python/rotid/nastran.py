"""Nastran bulk data by pyNastran: CBAR and CBEAM along a line as a Rotor."""
import contextlib
import io
import math

import numpy as np

from .chain import Beam, Mass, in_si, rotor_of, units_of
from .program import RotidError
from .rotor import Material, near, refuse

ATTACHED = {"CONM2"}
LEFT_OUT = {"SPC", "SPC1", "SPCADD", "MPC", "FORCE", "MOMENT", "GRAV", "EIGRL", "EIGR", "PARAM", "ENDDATA", "GRID", "CORD2R", "MAT1", "PBAR", "PBARL",
            "PBEAM", "PBEAML", "CBAR", "CBEAM", "TEMPD", "LOAD", "EIGC", "FREQ", "FREQ1", "TABDMP1", "DLOAD", "RLOAD1", "RLOAD2", "DAREA"}


def from_nastran(source, units="SI"):
    """A bulk data file as a Rotor. units: SI, or MM for mm, t, N, MPa. CBAR with PBAR or PBARL, CBEAM with PBEAM or PBEAML, round sections;
    CONM2 as disks. RotidError with file and card for all that has no deck; constraints and loads are left out, with a warning."""
    from cpylog import SimpleLogger
    from pyNastran.bdf.bdf import BDF

    scale = units_of(units)
    model = BDF(debug=None, log=SimpleLogger("critical", log_func=lambda *_: None))
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):  # pyNastran prints cards that it cannot read
            model.read_bdf(str(source), xref=False, punch=None if has_bulk(source) else True)
    except OSError as error:
        refuse(source, None, f"cannot be read: {error.strerror or error}")
    except Exception as error:  # pyNastran raises RuntimeError, KeyError, SyntaxError, its own and bare ones for what is no bulk data
        refuse(source, None, f"pyNastran cannot read this: {' '.join(str(error).split())[:300] or type(error).__name__}")
    notes = {}
    for card, count in sorted(model.card_count.items()):
        if card not in LEFT_OUT | ATTACHED:
            refuse(source, card, f"{count} of them have no place in a deck, expected CBAR, CBEAM and CONM2 with what they refer to")
    left = sorted(set(model.card_count) & {"SPC", "SPC1", "SPCADD", "MPC"}) + ["PS of GRID"] * any(grid.ps for grid in model.nodes.values())
    if left:
        notes[f"{', '.join(left)} are left out: state supports as *SPRING"] = None
    for factor in factors_on_masses(model):
        if factor not in (1, "1", "1."):
            refuse(source, "PARAM WTMASS", f"multiplies all masses by {factor}, expected masses and densities without a factor")
    for kind, number, _ in model.superelement_models:
        refuse(source, f"BEGIN {kind}={number}", "begins a part of the model by itself, expected all in one BEGIN BULK")
    place = {}
    for node, grid in model.nodes.items():
        try:
            place[node] = np.array([in_si(x, scale["length"]) for x in grid.get_position_no_xref(model)])
        except Exception as error:
            refuse(source, f"GRID {node}", f"its place is not known: {error}")
        if not np.all(np.isfinite(place[node])):
            refuse(source, f"GRID {node}", f"is at {place[node].tolist()}, expected numbers")
    materials, beams = {}, []
    for number, element in sorted(model.elements.items()):
        beams.append(beam_of(source, model, number, element, materials, scale, notes))
    masses = [mass_of(source, number, mass, scale) for number, mass in sorted(model.masses.items())]
    for beam in beams:
        for node in beam.ends:
            if node not in place:
                refuse(source, beam.where, f"GRID {node} is not there")
    return rotor_of(source, f"From Nastran bulk data {str(source).rsplit('/', 1)[-1]}", place, beams, masses, [], notes)


def factors_on_masses(model):
    """PARAM,WTMASS: numbers of the bulk data; texts of the case control, where pyNastran keeps one PARAM of a subcase."""
    if "WTMASS" in model.params:
        yield model.params["WTMASS"].values[0]
    for line in model.case_control_lines or []:
        words = line.partition("$")[0].replace(",", " ").split()
        if [word.upper() for word in words[:2]] == ["PARAM", "WTMASS"]:
            yield " ".join(words[2:])


def has_bulk(source):
    with open(source, encoding="latin-1") as stream:
        return any(line.strip().upper().startswith("BEGIN BULK") for line in stream)


def beam_of(source, model, number, element, materials, scale, notes):
    where = f"{element.type} {number}"
    for name in ("wa", "wb"):
        if np.any(np.asarray(getattr(element, name), dtype=float)):
            refuse(source, where, f"{name} {list(map(float, getattr(element, name)))} puts it beside its nodes, expected no offset")
    if getattr(element, "pa", 0) or getattr(element, "pb", 0):
        refuse(source, where, "pin flags release its ends, expected it joined to its nodes")
    properties = model.properties.get(element.pid)
    if properties is None or properties.type not in SECTIONS:
        refuse(source, where, f"property {element.pid} is {properties.type if properties else 'not there'}, expected {', '.join(SECTIONS)}")
    of = f"{properties.type} {properties.pid}"
    if np.any(np.atleast_1d(np.asarray(properties.nsm, dtype=float))):
        refuse(source, of, "has non-structural mass, expected a density")
    if any(getattr(properties, name, 0) for name in ("n1a", "n2a", "n1b", "n2b")):
        refuse(source, of, "its neutral axis lies beside its nodes, expected no offset")
    sections = [tuple(in_si(d, scale["length"]) for d in section) for section in SECTIONS[properties.type](source, of, properties)]
    outer, inner = zip(*sections)
    for o, i in sections:
        if not 0 <= i < o:
            refuse(source, of, f"has the diameters {o:g} and {i:g} m, expected the inner one not below zero and below the outer one")
    return Beam((element.ga, element.gb), inner, outer, material_of(source, model, of, properties.mid, materials, scale, notes), where)


def material_of(source, model, of, number, materials, scale, notes):
    if number in materials:
        return materials[number]
    material = model.materials.get(number)
    if material is None or material.type != "MAT1":
        refuse(source, of, f"material {number} is {material.type if material else 'not there'}, expected a MAT1")
    values = {"E": material.e, "G": material.g, "RHO": material.rho}
    for name, value in values.items():
        if value is None or not (math.isfinite(value) and value > 0):
            refuse(source, f"MAT1 {number}", f"{name} is {value}, expected a number above zero")
    materials[number] = Material.of(f"mat{number}", in_si(material.e, scale["modulus"]), in_si(material.g, scale["modulus"]), in_si(material.rho, scale["density"]), notes)
    return materials[number]


def from_area(source, of, area, i1, i2, i12):
    """Diameters of the round section of this area and inertia: outer^2, inner^2 = 8 I/A +- 2 A/pi."""
    if not (area > 0 and i1 > 0 and near(i1, i2, 1e-6)) or abs(i12) > 1e-9 * i1:
        refuse(source, of, f"has A {area:g}, I1 {i1:g}, I2 {i2:g}, I12 {i12:g}, expected those of a round section")
    inner2 = 8 * i1 / area - 2 * area / math.pi
    outer2 = 8 * i1 / area + 2 * area / math.pi
    if inner2 < -1e-5 * outer2:
        refuse(source, of, f"has I1 {i1:g}, less than a full circle of its area has ({area**2 / (4 * math.pi):g}), expected a round section")
    return math.sqrt(outer2), math.sqrt(inner2) if inner2 > 1e-5 * outer2 else 0.0


def of_pbar(source, of, p):
    return [from_area(source, of, p.A, p.i1, p.i2, p.i12)] * 2


def of_pbeam(source, of, p):
    return [from_area(source, of, p.A[i], p.i1[i], p.i2[i], p.i12[i]) for i in stations_of(source, of, p)]


def stations_of(source, of, p):
    """The first and the last station; between them the section is taken as linear, as Nastran takes it."""
    places = [float(x) for x in p.xxb]
    if places not in ([0.0], [0.0, 1.0]):
        refuse(source, of, f"has stations at {places}, expected one section or one at each end")
    return [0, len(places) - 1]


def diameters(source, of, kind, dim):
    if kind == "ROD" and len(dim) >= 1:
        return 2 * float(dim[0]), 0.0
    if kind == "TUBE" and len(dim) >= 2:
        return 2 * float(dim[0]), 2 * float(dim[1])
    if kind == "TUBE2" and len(dim) >= 2:
        return 2 * float(dim[0]), 2 * (float(dim[0]) - float(dim[1]))
    refuse(source, of, f"is a {kind} section, expected ROD, TUBE or TUBE2")


def of_pbarl(source, of, p):
    return [diameters(source, of, p.beam_type, p.dim)] * 2


def of_pbeaml(source, of, p):
    return [diameters(source, of, p.beam_type, p.dim[i]) for i in stations_of(source, of, p)]


SECTIONS = {"PBAR": of_pbar, "PBARL": of_pbarl, "PBEAM": of_pbeam, "PBEAML": of_pbeaml}


def mass_of(source, number, mass, scale):
    where = f"{mass.type} {number}"
    if mass.type != "CONM2":
        refuse(source, where, "has no place in a deck, expected CONM2")
    if np.any(np.asarray(mass.X, dtype=float)):
        refuse(source, where, "its mass lies beside its node, expected no offset")
    if mass.cid:
        refuse(source, where, "has a coordinate system of its own, expected the basic one")
    i11, i21, i22, i31, i32, i33 = (in_si(i, scale["mass"] * scale["length"] ** 2) for i in mass.I)
    if not (math.isfinite(mass.mass) and mass.mass >= 0):
        refuse(source, where, f"has the mass {mass.mass}, expected a number not below zero")
    return Mass(mass.nid, in_si(mass.mass, scale["mass"]), np.array([[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]]), where)

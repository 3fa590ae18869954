"""Input of Abaqus and CalculiX: B31 along a line as a Rotor, by a reader of its own for the cards that such a model has."""
import math
from pathlib import Path

import numpy as np

from .chain import STRAIGHT, Beam, Mass, Spring, in_si, rotor_of, units_of
from .rotor import Material, refuse

BEAMS = ("B31", "B31R")
CARD_OF = {"MASS": "MASS", "ROTARYI": "ROTARY INERTIA", "SPRING1": "SPRING"}  # what says how large such an element is
# cards that say nothing of what the rotor is
PASSED = {"HEADING", "PREPRINT", "RESTART", "NSET", "AMPLITUDE"}
LEFT_OUT = {"BOUNDARY": "supports: state them as *SPRING", "TRANSVERSE SHEAR STIFFNESS": "the shear stiffness follows from the section",
            "INITIAL CONDITIONS": "frequencies do not depend on them"}


class Card:
    def __init__(self, source, line, text):
        self.source, self.line, self.rows, self.options = source, line, [], {}
        name, comma, options = text[1:].partition(",")
        self.name = " ".join(name.upper().split())
        self.take(line, comma + options)

    def take(self, line, text):
        """Options; behind a comma the line goes on in the next one."""
        self.goes_on = text.endswith(",")
        for option in filter(None, (part.strip() for part in text.split(","))):
            key, _, value = option.partition("=")
            if line != self.line and not key[:1].isalpha():
                self.wrong(f"'{option[:40]}' is no option, expected one where the line before ends with a comma", line)
            self.options["".join(key.upper().split())] = value.strip()

    def wrong(self, text, line=None):
        refuse(self.source, f"line {line or self.line}", f"*{self.name}: {text}")

    def need(self, option):
        if not self.options.get(option):
            self.wrong(f"has no {option}, expected {option}=NAME")
        return self.options[option].upper()


def cards_of(source):
    try:
        text = Path(source).read_text(encoding="latin-1")
    except OSError as error:
        refuse(source, None, f"cannot be read: {error.strerror or error}")
    cards = []
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        if line.startswith("*"):
            cards.append(Card(source, number, line))
            cards[-1].pending = False
        elif not cards:
            refuse(source, f"line {number}", f"'{line[:40]}' belongs to no card, expected an input file of Abaqus or CalculiX")
        elif cards[-1].goes_on:
            cards[-1].take(number, line)
        else:
            fields = [field.strip() for field in line.split(",")]
            goes_on = line.endswith(",") and cards[-1].name in ("ELEMENT", "ELSET")
            if cards[-1].pending:
                cards[-1].rows[-1][1].extend(fields)
            else:
                cards[-1].rows.append((number, fields))
            cards[-1].pending = goes_on
    return cards


def value(card, line, fields, i, what, least=None, default=None):
    text = fields[i] if i < len(fields) else ""
    if not text and default is not None:
        return default
    try:
        found = float(text.lower().replace("d", "e").replace("_", "?"))  # 2_1 is 21 to Python alone
    except ValueError:
        found = math.nan
    if not math.isfinite(found) or (least is not None and found < least):
        card.wrong(f"{what} is '{text[:40]}', expected a number{'' if least is None else f' not below {least:g}'}", line)
    return found


def whole(card, line, text, what):
    if not text.isdecimal() or len(text) > 9:
        card.wrong(f"{what} is '{text[:40]}', expected a number of a node or an element", line)
    return int(text)


class Reader:
    def __init__(self, source, scale):
        self.source, self.scale, self.notes = source, scale, {}
        self.place, self.elements, self.sets, self.materials, self.sections, self.masses, self.springs = {}, {}, {}, {}, [], [], []
        self.line_of = {}  # a node
        self.current, self.given = None, {}

    def read(self):
        in_step, sets = False, []
        for card in cards_of(self.source):
            if card.name in ("STEP", "END STEP"):
                in_step = card.name == "STEP"
            elif card.name in LEFT_OUT:  # in a step as well
                if card.name == "INITIAL CONDITIONS" and card.options.get("TYPE", "").upper() == "STRESS":
                    card.wrong("TYPE=STRESS changes the frequencies, expected none: a deck has *PRELOAD")
                self.notes[f"*{card.name} is left out: {LEFT_OUT[card.name]}"] = None
            elif in_step or card.name in PASSED:
                continue
            elif "INPUT" in card.options:
                card.wrong(f"INPUT={card.options['INPUT'][:40]} is another file, expected its lines here")
            elif card.name == "ELSET":
                sets.append(card)
            else:
                reader = getattr(self, card.name.lower().replace(" ", "_"), None) if card.name in READ else None
                if not reader:
                    card.wrong(f"has no place in a deck, expected {', '.join('*' + name for name in sorted(READ))}")
                reader(card)
        for card in sets:  # a set may stand before its elements
            self.elset(card)

    def node(self, card):
        if card.options.get("SYSTEM", "R").upper() != "R":
            card.wrong(f"SYSTEM={card.options['SYSTEM']}, expected rectangular coordinates")
        for line, fields in card.rows:
            number = whole(card, line, fields[0], "the node")
            place = np.array([in_si(value(card, line, fields, 1 + c, "xyz"[c], default=0.0), self.scale["length"]) for c in range(3)])
            if (place != self.place.setdefault(number, place)).any():
                card.wrong(f"node {number} is another place in line {self.line_of[number]}, expected one", line)
            self.line_of.setdefault(number, line)

    def element(self, card):
        kind = card.need("TYPE")
        if kind not in (*BEAMS, "MASS", "SPRING1", "ROTARYI"):
            card.wrong(f"TYPE={kind} has no place in a deck, expected {', '.join(BEAMS)}, MASS, ROTARYI or SPRING1")
        for line, fields in card.rows:
            fields = [field for field in fields if field]
            number, *nodes = (whole(card, line, field, "an element or a node") for field in fields)
            if len(nodes) not in ((2, 3) if kind in BEAMS else (1,)):
                card.wrong(f"element {number} has {len(nodes)} nodes, expected {2 if kind in BEAMS else 1}", line)
            nodes = nodes[:2]  # a third node is the direction of the section, which is round
            if number in self.elements:
                card.wrong(f"element {number} occurs twice, first in line {self.elements[number][2]}", line)
            self.elements[number] = (kind, nodes, line)
            if card.options.get("ELSET"):
                self.sets.setdefault(card.options["ELSET"].upper(), {})[number] = None

    def elset(self, card):
        members = self.sets.setdefault(card.need("ELSET"), {})
        for line, fields in card.rows:
            fields = [field for field in fields if field]
            if "GENERATE" in card.options:
                numbers = [whole(card, line, field, "an element") for field in fields]
                if len(numbers) not in (2, 3) or (len(numbers) == 3 and numbers[2] < 1):
                    card.wrong("expected first, last and step", line)
                first, last, step = (*numbers, 1)[:3]
                members.update(dict.fromkeys(n for n in sorted(self.elements) if first <= n <= last and (n - first) % step == 0))
                continue
            for field in fields:
                if field.upper() in self.sets:
                    members.update(self.sets[field.upper()])
                else:
                    members[whole(card, line, field, "an element or a set")] = None

    def material(self, card):
        self.current = {"name": card.need("NAME"), "line": card.line}
        if self.current["name"] in self.materials:
            card.wrong(f"{self.current['name'][:40]} occurs twice, first in line {self.materials[self.current['name']]['line']}")
        self.materials[self.current["name"]] = self.current

    def once(self, card, key):
        if key in self.current:
            card.wrong(f"the material {self.current['name'][:40]} has one already, expected one")

    def elastic(self, card):
        if card.options.get("TYPE", "ISO").upper() not in ("ISO", "ISOTROPIC", "ENGINEERING CONSTANTS"):
            card.wrong(f"TYPE={card.options['TYPE']}, expected ISOTROPIC or ENGINEERING CONSTANTS")
        if not card.rows or self.current is None:
            card.wrong("expected E and Poisson's ratio behind a *MATERIAL")
        self.once(card, "e")
        line, fields = card.rows[0]
        if card.options.get("TYPE", "ISO").upper().startswith("ENG"):
            fields = [field for _, more in card.rows for field in more]
            e, g, other = (value(card, line, fields, at, name, 0) for at, name in ((0, "E1"), (6, "G12"), (7, "G13")))
            if g != other:
                card.wrong(f"G12 is {g:g} and G13 {other:g}, expected the same across axis 1", line)
            self.current["of_axes"] = card
        else:
            e, nu = value(card, line, fields, 0, "E", 0), value(card, line, fields, 1, "Poisson's ratio", default=0.0)
            if len(card.rows) > 1:
                self.notes[f"line {line}: of E at {len(card.rows)} temperatures the first one, {e:g}, is taken"] = None
            if not -1 < nu <= 0.5:
                card.wrong(f"Poisson's ratio is {nu:g}, expected one above -1 and at most 0.5", line)
            g = e / (2 * (1 + nu))
        if not (e > 0 and g > 0):
            card.wrong(f"E is {e:g} and G {g:g}, expected both above zero", line)
        self.current.update(e=in_si(e, self.scale["modulus"]), g=in_si(g, self.scale["modulus"]))

    def density(self, card):
        if not card.rows or self.current is None:
            card.wrong("expected a density behind a *MATERIAL")
        self.once(card, "rho")
        self.current["rho"] = in_si(value(card, *card.rows[0], 0, "the density", 0), self.scale["density"])
        if len(card.rows) > 1:
            self.notes[f"line {card.rows[0][0]}: of {len(card.rows)} densities the first one, {self.current['rho']:g} kg/m3, is taken"] = None

    def beam_section(self, card):
        kind = card.need("SECTION")
        if kind not in ("CIRC", "PIPE"):
            card.wrong(f"SECTION={kind} is not round, expected CIRC or PIPE")
        for option in ("OFFSET1", "OFFSET2"):
            if value(card, card.line, [card.options.get(option, "")], 0, option, default=0.0):
                card.wrong(f"{option} puts it beside its nodes, expected no offset")
        if not card.rows:
            card.wrong("has no data line, expected the dimensions")
        line, fields = card.rows[0]
        first = in_si(value(card, line, fields, 0, "the radius", 0), self.scale["length"])
        second = value(card, line, fields, 1, "the second dimension", 0, first if kind == "CIRC" else None)
        second = second if len(fields) < 2 or not fields[1] else in_si(second, self.scale["length"])
        if kind == "CIRC" and second != first:
            card.wrong(f"has the diameters {first:g} and {second:g} m, expected a circle", line)
        if kind == "CIRC" and len(fields) > 1 and fields[1]:
            first = second = first / 2  # CalculiX has two diameters where Abaqus has one radius
        inner = 0.0 if kind == "CIRC" else first - second
        if not 0 <= inner < first:
            card.wrong(f"has the outer radius {first:g} m and the wall {second:g} m, expected a wall above zero and not above the radius", line)
        self.sections.append((card, card.need("ELSET"), card.need("MATERIAL"), 2 * inner, 2 * first))

    def mass(self, card):
        if card.options.get("TYPE", "ISOTROPIC").upper() != "ISOTROPIC":
            card.wrong(f"TYPE={card.options['TYPE']}, expected one mass in all directions")
        self.masses.append((card, card.need("ELSET"), in_si(value(card, *self.only(card), 0, "the mass", 0), self.scale["mass"])))

    def only(self, card):
        if len(card.rows) < 1:
            card.wrong("has no data line")
        return card.rows[0]

    def rotary_inertia(self, card):
        line, fields = self.only(card)
        i = [in_si(value(card, line, fields, c, "an inertia", default=0.0), self.scale["mass"] * self.scale["length"] ** 2) for c in range(6)]
        self.masses.append((card, card.need("ELSET"), np.array([[i[0], i[3], i[4]], [i[3], i[1], i[5]], [i[4], i[5], i[2]]])))

    def spring(self, card):
        if "NONLINEAR" in card.options or len(card.rows) != 2:
            card.wrong("expected a degree of freedom and one stiffness")
        dof = whole(card, card.rows[0][0], card.rows[0][1][0], "the degree of freedom")
        stiffness = in_si(value(card, *card.rows[1], 0, "the stiffness", 0), self.scale["modulus"] * self.scale["length"])
        self.springs.append((card, card.need("ELSET"), dof, stiffness))

    def members(self, card, name, kinds):
        """Elements of a set, each once and of one card alone, however often it was put into the set."""
        if name not in self.sets:
            card.wrong(f"the element set {name[:40]} is not there")
        for number in self.sets[name]:
            if number not in self.elements:
                card.wrong(f"element {number} of the set {name[:40]} is not there")
            if self.elements[number][0] not in kinds:
                card.wrong(f"element {number} is a {self.elements[number][0]}, expected {' or '.join(kinds)}")
            if number in self.given:
                card.wrong(f"element {number} has a *{self.given[number].name} already, expected one")
            self.given[number] = card
            yield number, self.elements[number][1]

    def material_of(self, card, name):
        material = self.materials.get(name)
        if material is None:
            card.wrong(f"the material {name[:40]} is not there")
        for key, word in (("e", "*ELASTIC"), ("rho", "*DENSITY")):
            if not material.get(key):
                refuse(self.source, f"line {material['line']}", f"*MATERIAL, NAME={name[:40]} has no {word}, expected one above zero")
        if "of_axes" in material and not self.is_across(2, 3):
            material["of_axes"].wrong("is of the axes of the file, expected the rotor along axis 1, that of E1 and G12")
        if "made" not in material:
            material["made"] = Material.of(name, material["e"], material["g"], material["rho"], self.notes)
        return material["made"]

    def rotor(self):
        beams = []
        for card, elset, name, inner, outer in self.sections:
            for number, nodes in self.members(card, elset, BEAMS):
                beams.append(Beam(tuple(nodes), (inner, inner), (outer, outer), self.material_of(card, name), f"element {number}"))
        for number, (kind, nodes, line) in self.elements.items():
            for node in nodes:
                if node not in self.place:
                    refuse(self.source, f"line {line}", f"node {node} of element {number} is not there")
        masses = []
        for card, elset, amount in self.masses:
            rotary = isinstance(amount, np.ndarray)
            for number, (node,) in self.members(card, elset, ("ROTARYI",) if rotary else ("MASS",)):
                masses.append(Mass(node, 0.0 if rotary else amount, amount if rotary else np.zeros((3, 3)), f"mass {number}"))
        springs = {}
        for card, elset, dof, stiffness in self.springs:
            for number, (node,) in self.members(card, elset, ("SPRING1",)):
                springs.setdefault(node, []).append((dof, stiffness, number, card))
        for number, (kind, _, line) in self.elements.items():
            if number not in self.given:
                refuse(self.source, f"line {line}", f"element {number} has no *{CARD_OF.get(kind, 'BEAM SECTION')}, expected one")
        return rotor_of(self.source, f"From input of Abaqus or CalculiX {str(self.source).rsplit('/', 1)[-1]}", self.place, beams, masses,
                        self.lateral(springs), self.notes)

    def is_across(self, *directions):
        """Whether the rotor has no extent in these directions of the file."""
        used = np.array([self.place[n] for kind, nodes, _ in self.elements.values() if kind in BEAMS for n in nodes if n in self.place])
        extent = np.ptp(used, axis=0)
        return all(extent[d - 1] <= STRAIGHT * extent.max() for d in directions)

    def lateral(self, springs):
        """Springs across the axis, the same in both directions or in one."""
        for node, found in springs.items():
            for dof, _, number, card in found:
                if dof not in (1, 2, 3) or not self.is_across(dof):
                    card.wrong(f"spring {number} acts on degree of freedom {dof}, expected one across the axis, from 1 to 3")
            sums = {}
            for dof, stiffness, _, _ in found:
                sums[dof] = sums.get(dof, 0.0) + stiffness
            if len(set(sums.values())) > 1:
                found[0][3].wrong(f"springs at node {node} have {sorted(sums.values())} N/m in two directions, expected the same")
            yield Spring(node, next(iter(sums.values())), f"spring {found[0][2]}")


READ = {"NODE", "ELEMENT", "ELSET", "MATERIAL", "ELASTIC", "DENSITY", "BEAM SECTION", "MASS", "ROTARY INERTIA", "SPRING"}


def from_abaqus(source, units="SI"):
    """An input file of Abaqus or CalculiX as a Rotor. units: SI, or MM for mm, t, N, MPa. B31 with round sections (CIRC, PIPE), MASS and
    ROTARYI as disks, SPRING1 across the axis. RotidError with file and line for all that has no deck; steps are passed over, of their
    *BOUNDARY with a warning."""
    reader = Reader(source, units_of(units))
    reader.read()
    return reader.rotor()

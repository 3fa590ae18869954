"""The part of a deck that a solid of bricks needs: sections, layers, materials, springs. Written from docs/deck.md alone."""
import re
from dataclasses import dataclass, field
from pathlib import Path

# what is measured, fitted or printed does not concern the body
OTHER = {"HEADING", "SENSORS", "MODES", "SHAPE", "FREQUENCIES", "MEASURED", "NOISE", "FIT", "IDENTIFY", "DATA", "FRF", "DIAGNOSE"}
KNOWN = {"MATERIAL", "ELASTIC", "DENSITY", "SHAFT", "LAYER", "SPRING"}


class DeckError(Exception):
    pass


@dataclass
class Material:
    """Transversely isotropic about z, isotropic in the plane; axial_nu: contraction of the plane by axial stress."""
    axial_e: float = 0
    axial_g: float = 0
    plane_e: float = 0
    plane_nu: float = 0
    axial_nu: float = 0
    rho: float = 0
    laminated: bool = False  # sheets: the plane keeps its moduli when those along the axis change


@dataclass
class Section:
    """From z to z + length; rings of (inner radius, outer radius, material name) in m, and for each the group or layer it is of."""
    group: str
    z: float
    length: float
    rings: list
    names: list


@dataclass
class Deck:
    materials: dict = field(default_factory=dict)
    sections: list = field(default_factory=list)
    springs: list = field(default_factory=list)  # (z, N/m)

    @property
    def length(self):
        return self.sections[-1].z + self.sections[-1].length


def cards(path):
    """(line number, name, options, data lines) of every card; a data line is (line number, fields)."""
    found, continued = [], False
    for number, raw in enumerate(Path(path).read_text(encoding="utf-8-sig").splitlines(), 1):
        line = raw.split("**")[0].strip()
        if not line:
            continue
        if line.startswith("*") or continued:
            parts = [part.strip() for part in line.lstrip("*").split(",")]
            if not continued:
                found.append((number, parts.pop(0).upper(), {}, []))
            continued = line.endswith(",")
            for part in filter(None, parts):
                key, _, value = part.partition("=")
                found[-1][2][key.strip().upper()] = value.strip()
        elif found:
            found[-1][3].append((number, [part.strip() for part in line.rstrip(",").split(",")]))
    return found


def elastic(options, values):
    """Material of one *ELASTIC. TYPE=SHEAR says nothing of the plane: E and nu hold there, and nu for axial stress too."""
    kind = options.get("TYPE", "ISOTROPIC").upper()
    if kind == "ISOTROPIC":
        e, nu = values
        return Material(e, e / (2 * (1 + nu)), e, nu, nu)
    if kind == "SHEAR":
        e, g, nu = values
        return Material(e, g, e, nu, nu)
    if kind == "LAMINATED":
        e, g, sheet_e, nu, stacking = values if len(values) == 5 else [*values, 1.0]
        return Material(e, g, stacking * sheet_e, nu, nu * e / sheet_e, laminated=True)
    raise ValueError(f"TYPE={kind}")


def position(deck, text):
    """z [m] of a number, start, end, GROUP.start or GROUP.end."""
    if re.fullmatch(r"[-+.\d].*", text):
        if not 0 <= float(text) <= deck.length:
            raise ValueError(f"{text} is not inside the rotor")
        return float(text)
    group, _, end = text.lower().rpartition(".")
    inside = [s for s in deck.sections if group in ("", s.group)]
    return {"start": inside[0].z, "end": inside[-1].z + inside[-1].length}[end]


def read_section(deck, options, values):
    length, outer, inner = values[:3]
    if len(values) > 4 and values[4] != outer:
        raise ValueError("a diameter that carries stiffness belongs to beams")
    z = deck.length if deck.sections else 0.0
    ring, name = (inner / 2, outer / 2, options["MATERIAL"].lower()), options["NAME"].lower()
    deck.sections.append(Section(name, z, length, [ring], [name]))


def read_layer(deck, options, lines):
    inside = [s for s in deck.sections if s.group == options["GROUP"].lower()]
    rows = [[float(text) for text in fields] for _, fields in lines]
    if len(rows) == 1:
        rows *= len(inside)
    for section, (outer, inner) in zip(inside, rows, strict=True):
        if any(inner / 2 < b and a < outer / 2 for a, b, _ in section.rings):
            raise ValueError("layers overlap")
        section.rings.append((inner / 2, outer / 2, options["MATERIAL"].lower()))
        section.names.append(options["NAME"].lower())


def read(path):
    """Deck of a file. Layers and springs come last: they name groups that may follow them."""
    deck, name = Deck(), None
    found = cards(path)
    found = found[:next((i for i, c in enumerate(found) if c[1] == "RUNNING"), len(found))]  # what follows is the machine in operation
    for number, card, options, lines in sorted(found, key=lambda c: (c[1] in ("LAYER", "SPRING"), c[0])):
        if card not in KNOWN | OTHER:
            raise DeckError(f"{path}:{number}: *{card} is not supported by a solid of bricks")
        try:
            values = [float(text) for text in lines[0][1]] if card in ("ELASTIC", "DENSITY") else []
            if card == "MATERIAL":
                name = options["NAME"].lower()
                deck.materials[name] = Material()
            elif card == "ELASTIC":
                rho = deck.materials[name].rho
                deck.materials[name] = elastic(options, values)
                deck.materials[name].rho = rho
            elif card == "DENSITY":
                deck.materials[name].rho = values[0]
            elif card == "SHAFT":
                for _, fields in lines:
                    read_section(deck, options, [float(text) for text in fields])
            elif card == "LAYER":
                read_layer(deck, options, lines)
            elif card == "SPRING":
                for _, fields in lines:
                    if len(fields) > 2 and float(fields[2]):
                        raise ValueError("a spring against rotation is not supported")
                    deck.springs.append((position(deck, fields[0]), float(fields[1])))
        except (ValueError, KeyError, IndexError, TypeError) as error:
            raise DeckError(f"{path}:{number}: *{card}: {error!r}") from error
    for section in deck.sections:
        for _, _, material in section.rings:
            if material not in deck.materials or deck.materials[material].rho <= 0:
                raise DeckError(f"{path}: material {material} of {section.group} needs *ELASTIC and *DENSITY")
    if not deck.sections or not deck.springs:
        raise DeckError(f"{path}: needs *SHAFT and *SPRING (without springs the stiffness is singular)")
    return deck

"""The Python package of tools/python, as pip has installed it: commands as dicts and arrays, refusals with their places; rotors of ROSS, of
Nastran (pyNastran) and of Abaqus and CalculiX as decks; rotors of rotid as ROSS has them, drawn too. Frequencies are those of the matrices of
ROSS, of closed forms, and of decks written by hand."""
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import rotid
from export_peer import CORE, DECKS, POLAR, SENSORS, SHAFT, STEEL, SUPPORTS, elastic, lowest_hz
from support import INPUT, Checks, temporary_folder

EXACT = 1e-9
PROGRAM = str(Path(sys.argv[1]).resolve())


def noted(call, *arguments, **options):
    """What is returned, and the texts of the warnings of the package."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        out = call(*arguments, **options)
    return out, [str(w.message) for w in found if w.category is UserWarning]


def refused(checks, name, part, call, *arguments, place=None, **options):
    """RotidError whose text has the part and, where one is asked for, the place."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            call(*arguments, **options)
    except rotid.RotidError as error:
        return checks.true(f"{name} is refused", part in str(error) and (place is None or str(place) in str(error)), str(error))
    except Exception as error:
        return checks.true(f"{name} is refused", False, f"{type(error).__name__}: {error}")
    return checks.true(f"{name} is refused", False, "nothing was said")


def full_hz(deck):
    modes = rotid.run("modes", deck)
    return np.r_[modes["rigid_hz"], [mode["full_hz"] for mode in modes["modes"]]]


def bending_hz(deck):
    return [mode["full_hz"] for mode in rotid.run("modes", deck)["modes"]]


def written(source, deck):
    """The rotor as a deck, and what was said of it."""
    return noted(rotid.write_deck, source, deck)[1]


# ---- commands


def commands(checks, folder):
    checked = rotid.run("check", INPUT / "paper_rotor.inp")
    checks.true("run: numbers are numbers, lists of them arrays", checked["mass_kg"] > 900 and isinstance(checked["geometry"]["nodes_z_m"], np.ndarray), "")
    fit = rotid.run("identify", INPUT / "solid_rotor.inp", no_baseline=True, set={"FIT.MODES": "1-5"})
    checks.true("run: options of the command", fit.code in (0, 1) and sum(not mode["holdout"] for mode in fit["modes"]) == 5
                and fit["correlation"].shape == (2, 2), [mode["holdout"] for mode in fit["modes"]])
    deck = folder / "wrong.inp"
    deck.write_text(STEEL + "*SHAFT, NAME=a, MATERIAL=brass\n1, 0.1, 0, 4\n")
    try:
        rotid.run("check", deck)
        checks.true("run: a wrong deck raises", False)
    except rotid.RotidError as error:
        m = error.messages[0]
        checks.true("run: the message has file, line and column, the error the exit code", error.code == 2 and m.file == str(deck) and m.line == 6
                    and m.column > 1 and "brass" in m.text, (error.code, error.messages))
    refused(checks, "run: a deck that is not there", "absent.inp", rotid.run, "check", folder / "absent.inp")
    refused(checks, "run: an option that is not there", "--nothing", rotid.run, "check", INPUT / "paper_rotor.inp", nothing=True)
    bound = folder / "bound.inp"
    bound.write_text(STEEL + "*SHAFT, NAME=a, MATERIAL=steel\n1, 0.1, 0, 8\n*SENSORS\n1, 0\n2, 0.5\n3, 1\n*MODES\n1, 450\n2, 1200\n*IDENTIFY\na.E, 2.5e11, 1e12, 3e11\n")
    checks.true("run: a doubtful result is one, with code 1", rotid.run("identify", bound, no_baseline=True).code == 1, "")


# ---- from ROSS


def material(**changed):
    return {"name": "steel", "rho": 7850, "E": 2.1e11, "G_s": 8.1e10, **changed}


def element(n, **changed):
    return {"L": 0.5, "idl": 0, "odl": 0.1, "idr": 0, "odr": 0.1, "material": material(), "n": n, **changed}


def bearing(n, kxx=1e7, **changed):
    return {"n": n, "kxx": kxx, "kyy": kxx, "tag": f"b{n}", **changed}


def saved(path, **parts):
    root = {"ross_version": "2.3.0", "parameters": {}, "ShaftElement_a": element(0), "ShaftElement_b": element(1), **parts}
    path.write_text(json.dumps(root).replace('"1e999"', "1e999"))
    return path


def springs_of(checks, name, path, deck):
    """Positions and stiffnesses in the deck, and what was said."""
    said = written(rotid.from_ross(path), deck)
    return {s["z_m"]: s["lateral_n_m"] for s in rotid.run("check", deck)["geometry"]["springs"]}, said


def from_ross_refuses(checks, folder):
    path = folder / "wrong.json"
    wrong = {
        "L null": ({"ShaftElement_a": element(0, L=None)}, "ShaftElement_a.L: is null, expected a number above 0"),
        "L as text": ({"ShaftElement_a": element(0, L="one")}, "ShaftElement_a.L: is the text 'one'"),
        "L 1e999": ({"ShaftElement_a": element(0, L="1e999")}, "ShaftElement_a.L: is inf"),
        "L of 400 digits": ({"ShaftElement_a": element(0, L=10**400)}, "ShaftElement_a.L: is inf"),
        "a bearing of 400 digits": ({"BearingElement_b": bearing(0, [1e6, -10**400])}, "BearingElement_b.kxx: has -inf"),
        "L missing": ({"ShaftElement_a": {k: v for k, v in element(0).items() if k != "L"}}, "ShaftElement_a.L: is missing"),
        "density null": ({"ShaftElement_a": element(0, material=material(rho=None))}, "ShaftElement_a.material.rho: is null"),
        "E null": ({"ShaftElement_a": element(0, material=material(E=None))}, "ShaftElement_a.material.E: is null"),
        "E true": ({"ShaftElement_a": element(0, material=material(E=True))}, "ShaftElement_a.material.E: is true"),
        "material null": ({"ShaftElement_a": element(0, material=None)}, "ShaftElement_a.material: is null"),
        "diameter null": ({"ShaftElement_a": element(0, odr=None)}, "ShaftElement_a.odr: is null"),
        "inner above outer": ({"ShaftElement_a": element(0, idl=0.2)}, "ShaftElement_a.idl: is 0.2 and the outer diameter 0.1"),
        "node -1": ({"ShaftElement_a": element(-1)}, "ShaftElement_a.n: is -1, expected the number of a node"),
        "a gap": ({"ShaftElement_c": element(4)}, "ShaftElement_c.n: is 4, and the elements leave a gap"),
        "a ring that does not touch": ({"ShaftElement_c": element(1, idl=0.2, idr=0.2, odl=0.3, odr=0.3)}, "expected 0.1 m"),
        "a ring of another length": ({"ShaftElement_c": element(1, L=1, idl=0.1, idr=0.1, odl=0.3, odr=0.3)}, "ShaftElement_c.L: is 1, expected 0.5"),
        "a bearing as text": ({"BearingElement_b": bearing(0, "stiff")}, "BearingElement_b.kxx: is the text 'stiff'"),
        "a bearing null": ({"BearingElement_b": bearing(0, None)}, "BearingElement_b.kxx: is null"),
        "a bearing 1e999": ({"BearingElement_b": bearing(0, "1e999")}, "BearingElement_b.kxx: is inf"),
        "a bearing of an empty list": ({"BearingElement_b": bearing(0, [])}, "BearingElement_b.kxx: is an empty list"),
        "a bearing with null in its list": ({"BearingElement_b": bearing(0, [1e7, None])}, "BearingElement_b.kxx: has null"),
        "a bearing below zero": ({"BearingElement_b": bearing(0, -5)}, "BearingElement_b.kxx: is -5"),
        "a bearing without kxx": ({"BearingElement_b": {"n": 0, "kyy": 1e7, "n_link": 5}}, "BearingElement_b.kxx: is missing"),
        "kyy as text": ({"BearingElement_b": bearing(0, kyy="x")}, "BearingElement_b.kyy: is the text 'x'"),
        "a bearing beside the shaft": ({"BearingElement_b": bearing(9)}, "BearingElement_b.n: is 9, expected a node of the shaft, 0 to 2"),
        "a bearing between nodes of the shaft": ({"BearingElement_b": bearing(0, n_link=2)}, "joins the nodes 0 and 2 of the shaft"),
        "one support for two places": ({"BearingElement_a": bearing(0, n_link=3), "BearingElement_b": bearing(2, n_link=3), "BearingElement_c": bearing(3)},
                                       "BearingElement_a.n_link: joins the nodes 0 and 2 of the shaft"),
        "a disk below zero": ({"DiskElement_d": {"n": 1, "m": -1, "Id": 0, "Ip": 0}}, "DiskElement_d.m: is -1"),
        "a disk beside the shaft": ({"DiskElement_d": {"n": 7, "m": 1, "Id": 0, "Ip": 0}}, "DiskElement_d.n: is 7"),
        "a part that is not known": ({"GearBox_g": {"n": 1}}, "GearBox_g: is no part that rotid knows"),
    }
    for name, (parts, text) in wrong.items():
        refused(checks, f"from ROSS: {name}", text, lambda p: rotid.rotor.deck_of(rotid.from_ross(p)), saved(path, **parts), place=path)
    for name, text, part in (("no JSON", '{"a": ]', "line 1, column 7"), ("a list", "[1]", "is no rotor of ROSS"), ("NaN", '{"parameters": {}, "x": NaN}', "NaN"),
                             ("a key twice", '{"parameters": {}, "a": 1, "a": 2}', "occurs twice"), ("no bytes", "", "line 1"),
                             ("nothing along the axis", '{"parameters": {}}', "has no ShaftElement")):
        path.write_text(text)
        refused(checks, f"from ROSS: {name}", part, rotid.from_ross, path, place=path)
    refused(checks, "from ROSS: no file", "cannot be read", rotid.from_ross, folder / "absent.json", place="absent.json")


def from_ross_means(checks, folder):
    path, deck = folder / "rotor.json", folder / "rotor.inp"
    found, said = springs_of(checks, "kyy", saved(path, BearingElement_b={"n": 0, "kxx": 3e6, "tag": "b"}), deck)
    checks.true("from ROSS: a missing kyy is kxx, as in ROSS", found == {0: 3e6} and not said, (found, said))
    _, said = springs_of(checks, "masses", saved(path, PointMass_a={"n": 1, "mx": 2.0, "my": 2.0}, PointMass_b={"n": 2, "mx": 1.0, "my": 3.0}), deck)
    checks.true("from ROSS: of a PointMass mx, and my is told", rotid.run("check", deck)["geometry"]["disks"][1]["mass_kg"] == 1 and
                [s.split(": ")[2] for s in said] == ["PointMass_b"], said)
    found, said = springs_of(checks, "list", saved(path, SealElement_s=bearing(2, [3e6, 4e6])), deck)
    checks.true("from ROSS: of a list the first", found == {1.0: 3e6} and any("several speeds" in s for s in said), (found, said))
    parts = {"BearingElement_a": bearing(0, 3e7, n_link=3), "BearingElement_b": bearing(0, 2e7, n_link=3), "BearingElement_c": bearing(3, 5e7)}
    found, _ = springs_of(checks, "one support", saved(path, **parts), deck)
    checks.close("from ROSS: two bearings at one place on one support share it", found.values(), [5e7 * 5e7 / 1e8], 1e-14)
    parts = {"BearingElement_a": bearing(0, 3e7, n_link=3), "BearingElement_b": bearing(3, 6e7, n_link=4), "BearingElement_c": bearing(4, 2e7)}
    found, _ = springs_of(checks, "supports", saved(path, **parts), deck)
    checks.close("from ROSS: a support on a support is in series", found.values(), [1 / (1 / 3e7 + 1 / 6e7 + 1 / 2e7)], 1e-14)
    parts = {"BearingElement_a": bearing(0, 1e20, n_link=3), "BearingElement_b": bearing(3, 1e7)}
    found, _ = springs_of(checks, "rigid", saved(path, **parts), deck)
    checks.close("from ROSS: a rigid bearing leaves the support", found.values(), [1e7], 1e-12)
    found, _ = springs_of(checks, "loose", saved(path, BearingElement_a=bearing(0, n_link=3), BearingElement_b=bearing(3, 0.0)), deck)
    checks.true("from ROSS: a support that nothing holds is none", not found, found)

    sheets = material(name="sheets", E=1.25e11, G_s=3.3e10)
    said = written(rotid.from_ross(saved(path, ShaftElement_a=element(0, material=sheets))), deck)
    got = rotid.run("check", deck)["geometry"]["groups"][0]["material"]
    checks.true("from ROSS: E 1.25e11 with G 3.3e10 is TYPE=SHEAR", got["e_pa"] == 1.25e11 and got["g_pa"] == 3.3e10 and "TYPE=SHEAR" in deck.read_text()
                and any("isotropic" in s for s in said), (got, said))

    many = {f"ShaftElement_{n}": element(n, L=0.001 * (1 + n % 2), material=material(name="steel", rho=7850 + n % 2)) for n in range(5000)}
    path.write_text(json.dumps({"ross_version": "2.3.0", "parameters": {}, **many}))
    begin = time.process_time()
    rotor = rotid.from_ross(path)
    text, _ = rotid.rotor.deck_of(rotor)
    spent = time.process_time() - begin
    checks.true("from ROSS: 5,000 elements of two materials of one name in a second", spent < 1 and text.count("*SHAFT") == 5000
                and text.count("*MATERIAL") == 2, f"{spent:.2f} s")
    refused(checks, "from ROSS: more groups than a deck has cards", "more than 5000 cards", rotid.write_deck, rotor, deck, place=path)
    path.write_text(json.dumps({"ross_version": "2.3.0", "parameters": {}, **dict(list(many.items())[:2000])}))
    begin = time.monotonic()
    written(rotid.from_ross(path), deck)
    checks.true("from ROSS: 2,000 of them as a deck, read back", time.monotonic() - begin < 20 and rotid.run("check", deck)["elements"] == 2000,
                f"{time.monotonic() - begin:.1f} s")
    for n in range(5000):
        many[f"ShaftElement_{n}"]["material"]["rho"] = 7850
    path.write_text(json.dumps({"ross_version": "2.3.0", "parameters": {}, **many}))
    begin = time.monotonic()
    written(rotid.from_ross(path), deck)
    checks.true("from ROSS: 5,000 sections of one material as a deck, read back", rotid.run("check", deck)["elements"] == 5000, "")
    print(f"   5,000 elements: {spent:.2f} s of processor time for the text; of one material {time.monotonic() - begin:.2f} s to a deck that was read back")
    hostile = {"ShaftElement_\x1b[2J": element(2, L=None)}
    try:
        rotid.from_ross(saved(path, **hostile))
        checks.true("from ROSS: control characters do not pass", False)
    except rotid.RotidError as error:
        checks.true("from ROSS: control characters do not pass", "\x1b" not in str(error) and "\ufffd" in str(error), repr(str(error)))


def decks_are_whole(checks, folder):
    path, deck = folder / "rotor.json", folder / "kept.inp"
    deck.write_text("kept\n")
    rotor = rotid.from_ross(saved(path))
    rotor.disks.append(rotid.Part("far", 9.0, 1.0))
    refused(checks, "write: what rotid check refuses", "as a deck: ", rotid.write_deck, rotor, deck, place=path)
    checks.true("write: what was there is as it was, and nothing is left", deck.read_text() == "kept\n" and not list(folder.glob("kept.inp.*")), "")
    refused(checks, "write: a folder that is not there", "cannot write", rotid.write_deck, rotid.from_ross(path), folder / "no" / "x.inp")
    # what is read back as another rotor: the compared value is changed on its way
    other = rotid.from_ross(path)
    text, meant = rotid.rotor.deck_of(other)
    meant["groups"][0]["material"]["e_pa"] *= 1.001
    refused(checks, "write: a deck that is another rotor", "is another rotor (groups: steel)", rotid.rotor.read_back, other, _as_file(folder, text), meant, None)
    # as a command
    environment = {**os.environ, "ROTID": PROGRAM}
    done = subprocess.run([sys.executable, "-W", "ignore", "-m", "rotid", str(path), "-o", str(folder / "command.inp")], capture_output=True, text=True, env=environment)
    checks.true("python -m rotid writes a deck", done.returncode == 0 and (folder / "command.inp").exists(), done.stderr[-300:])
    saved(path, ShaftElement_a=element(0, L=None))
    done = subprocess.run([sys.executable, "-m", "rotid", str(path), "-o", str(folder / "none.inp")], capture_output=True, text=True, env=environment)
    checks.true("python -m rotid refuses with exit code 2 and the place", done.returncode == 2 and "ShaftElement_a.L: is null" in done.stderr
                and str(path) in done.stderr and not (folder / "none.inp").exists(), (done.returncode, done.stderr[-300:]))
    # a program that does not end: SIGTERM ends it and leaves nothing
    slow = folder / "slow"
    slow.write_text("#!/bin/sh\nexec sleep 60\n")
    slow.chmod(0o755)
    saved(path)
    child = subprocess.Popen([sys.executable, "-W", "ignore", "-m", "rotid", str(path), "-o", str(folder / "half.inp")],
                             env={**os.environ, "ROTID": str(slow)}, stderr=subprocess.DEVNULL)
    begin = time.monotonic()
    while not list(folder.glob("half.inp.*")) and time.monotonic() - begin < 20:
        time.sleep(0.01)
    time.sleep(0.1)
    child.send_signal(signal.SIGTERM)
    begin = time.monotonic()
    code = child.wait(timeout=30)
    checks.true("python -m rotid obeys SIGTERM and leaves nothing", code == 128 + signal.SIGTERM and time.monotonic() - begin < 1
                and not list(folder.glob("half.inp*")), (code, time.monotonic() - begin))


def _as_file(folder, text):
    path = folder / "other.inp"
    path.write_text(text)
    return path


def rings_of_ross(rs, rings):
    """Rings around a shaft, a bearing on a support, a disk, a force; elements of equal and of different lengths."""
    steel = rs.Material("steel", rho=7850, E=2.1e11, G_s=8.1e10)
    brass = rs.Material("brass,cast", rho=8500, E=1.0e11, G_s=3.7e10)
    shaft = [rs.ShaftElement(L=0.1, idl=0.01, odl=0.05, material=steel, n=n, axial_force=2e4) for n in range(4)]
    shaft += [rs.ShaftElement(L=0.06, idl=0, odl=0.07, material=steel, n=n) for n in range(4, 8)]
    shaft += [rs.ShaftElement(L=0.06, idl=0.07, odl=0.16, material=brass, n=n) for n in range(5, 7) if rings]
    shaft += [rs.ShaftElement(L=0.11, idl=0.02, odl=0.04, material=steel, n=8)]
    disks = [rs.DiskElement(n=5, m=12.5, Id=0.07, Ip=0.12)]
    bearings = [rs.BearingElement(n=0, kxx=3e7, cxx=100, n_link=10), rs.BearingElement(n=10, kxx=5e7, cxx=0), rs.BearingElement(n=9, kxx=2e7, kyy=1e7, cxx=0)]
    return rs.Rotor(shaft, disks, bearings, point_mass_elements=[rs.PointMass(n=10, m=1e-13)])


def cone_of_ross(rs):
    steel = rs.Material("steel", rho=7850, E=2.1e11, G_s=8.1e10)
    ends = np.linspace(0.08, 0.05, 41)
    shaft = [rs.ShaftElement(L=0.02, idl=0, odl=a, idr=0, odr=b, material=steel, n=n) for n, (a, b) in enumerate(zip(ends[:-1], ends[1:]))]
    return rs.Rotor(shaft, [], [rs.BearingElement(n=0, kxx=1e7, cxx=0), rs.BearingElement(n=40, kxx=1e7, cxx=0)])


def saved_hz(rotor, count, of_shaft):
    """The lowest bending frequencies in the plane x at rest; supports, which carry no mass, are condensed."""
    plane = np.sort(np.r_[0 : of_shaft * 6 : 6, 4 : of_shaft * 6 : 6])
    others = np.arange(of_shaft * 6, rotor.ndof, 3)
    k, m = rotor.K(0), rotor.M()
    stiffness = k[np.ix_(plane, plane)]
    if len(others):
        stiffness = stiffness - k[np.ix_(plane, others)] @ np.linalg.solve(k[np.ix_(others, others)], k[np.ix_(others, plane)])
    return lowest_hz(stiffness, m[np.ix_(plane, plane)], count)


def from_ross_bends(checks, folder):
    import ross as rs

    # rings of one section share its shear angle in rotid, in ROSS each has its own; a cone becomes shorter cylinders, a finer mesh
    cases = (("example of ROSS", rs.rotor_example(), 7, 1e-10), ("support, disk, force", rings_of_ross(rs, False), 10, 1e-10),
             ("rings", rings_of_ross(rs, True), 10, 1e-3), ("cone", cone_of_ross(rs), 41, 5e-3))
    deck = folder / "again.inp"
    for name, rotor, of_shaft, tolerance in cases:
        said = written(rotid.from_ross(rotor), deck)
        found = full_hz(deck)
        checks.close(f"from ROSS, {name}: frequencies", found, saved_hz(rotor, len(found), of_shaft), tolerance)
        checks.close(f"from ROSS, {name}: mass", [rotid.run("check", deck)["mass_kg"]], [rotor.m], 1e-4 if name == "cone" else 1e-12)
        checks.true(f"from ROSS, {name}: what is left out is told", all(any(part in s for s in said) for part in
                    (("damping", "kyy is not kxx", "masses on supports") if "support" in name else ())), said)


# ---- to ROSS


def plane_of(rotor, rows, matrix):
    at = np.sort(np.concatenate([np.arange(i, rotor.ndof, 6) for i in rows]))
    return matrix[np.ix_(at, at)], at


def bends_as(checks, name, rotor, out, tolerance=EXACT):
    """Both planes of the rotor have the bending frequencies of an export, at rest."""
    k, m = rotor.K(0), rotor.M()
    count = len(out["rigid_hz"]) + len(out["full_hz"])
    for plane, rows in (("x", (0, 4)), ("y", (1, 3))):
        stiffness, at = plane_of(rotor, rows, k)
        others = np.setdiff1d(np.arange(rotor.ndof), at)
        checks.true(f"to ROSS, {name}: plane {plane} is coupled to nothing at rest", not k[np.ix_(at, others)].any() and not m[np.ix_(at, others)].any(), "")
        hz = elastic(out, lowest_hz(stiffness, plane_of(rotor, rows, m)[0], count))
        found = np.array([hz[np.argmin(np.abs(hz - f))] for f in out["full_hz"]])
        kept = np.abs(found / out["full_hz"] - 1) < 0.05  # modes of rods and bars themselves are missing
        checks.close(f"to ROSS, {name}: frequencies in the plane {plane}", found[kept], out["full_hz"][kept], tolerance)
        checks.true(f"to ROSS, {name}: {kept.sum()} of {len(kept)} modes", kept.all() or tolerance > EXACT, out["full_hz"][~kept])
    checks.close(f"to ROSS, {name}: mass", [rotor.m], [out["mass_kg"]], 1e-9)
    g = rotor.G()
    checks.true(f"to ROSS, {name}: the gyroscopic matrix is antisymmetric", np.array_equal(g, -g.T), "")
    if name in POLAR:
        tilt = {"x": np.zeros(rotor.ndof), "y": np.zeros(rotor.ndof)}
        tilt["x"][0::6], tilt["x"][4::6] = rotor.nodes_pos, 1
        tilt["y"][1::6], tilt["y"][3::6] = rotor.nodes_pos, -1
        checks.close(f"to ROSS, {name}: polar inertia by a rigid tilt", [tilt["x"] @ g @ tilt["y"]], [POLAR[name]()], 1e-9)


def to_ross_whirls(checks, folder):
    """At speed as `rotid speeds` has it: a disk whose node is that of the end beside it, and tie rods between two nodes."""
    import csv

    rotor_cards = STEEL + ("*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.06, 0, 4\n*SHAFT, NAME=end, MATERIAL=steel\n0.3, 0.04, 0, 4\n*DISK, NAME=fan\n0.001, 9, 0.05, "
                           "0.1\n*SPRING\n0.1, 1e6\n*SPRING\nend, 1e7\n")
    deck, machine, diagram = folder / "rotor.inp", folder / "machine.inp", folder / "campbell.csv"
    for name, rods in (("disk beside a node", ""), ("disk of another inertia", "*CAUSE, NAME=c, TYPE=added_inertia, AT=fan\ninertia, 0.03\n"), *((f"tie rods, {model}", f"*TIEROD, NAME=rods, MATERIAL=steel, FROM=core.start, TO=core.end, MODEL="
                                                       f"{model}\n8, 0.02, 0.15, 0\n") for model in ("RODS", "TUBE"))):
        deck.write_text(rotor_cards + rods)
        machine.write_text(rotor_cards + rods + "*RUNNING\n*BEARING\nstart, 1e-3, 0\n*BEARING\nend, 1e-3, 0\n")
        rotor = noted(rotid.to_ross, deck)[0]
        rotid.run("speeds", machine, speeds="0:9000:2", draws=2, campbell=diagram)
        with open(diagram, encoding="utf-8", newline="") as stream:
            hz = np.array([float(row["frequency [Hz]"]) for row in csv.DictReader(stream) if float(row["speed [rpm]"]) == 9000])
        at = np.sort(np.concatenate([np.arange(i, rotor.ndof, 6) for i in (0, 1, 3, 4)]))
        k, m, g = (a[np.ix_(at, at)] for a in (rotor.K(0), rotor.M(), rotor.G()))
        n, speed = len(at), 9000 * np.pi / 30
        first_order = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, speed * g)]])
        found = np.abs(np.linalg.eigvals(first_order).imag) / (2 * np.pi)
        checks.close(f"to ROSS, {name}: frequencies at 9000 rpm", [found[np.argmin(np.abs(found - f))] for f in hz[:6]], hz[:6], 2e-4)
    deck.write_text(rotor_cards + "*STATE, NAME=bare\n*MODES\n1, 100\n*STATE, NAME=disc\n*DISK, NAME=hub\n0.3, 1, 0.01, 0.02\n*MODES\n1, 90\n")
    disks = noted(rotid.to_ross, deck, state="disc", start=True)[0].disk_elements
    checks.close("to ROSS: disks of a state", sorted(d.Ip for d in disks), [0.02, 0.1], 1e-12)


def export_of(deck, folder, **options):
    return rotid.run("export", deck, format="dmig", output=folder / "model.bdf", **options)


def to_ross_bends(checks, folder):
    for name, text in DECKS.items():
        deck = folder / "rotor.inp"
        deck.write_text(text)
        rotor, said = noted(rotid.to_ross, deck)
        said = [s for s in said if str(deck) in s]
        bends_as(checks, name, rotor, export_of(deck, folder), 2e-2 if "four elements" in name else EXACT)
        plain = name in ("free, hollow, no sensors", "thin ring of holes near the rim")
        checks.true(f"to ROSS, {name}: what ROSS has no element for is told", bool(said) != plain, said)
    for name in ("paper_rotor.inp", "solid_rotor.inp", "brake_reuss_beam.inp"):  # fitted first
        bends_as(checks, name, noted(rotid.to_ross, INPUT / name)[0], export_of(INPUT / name, folder))
    import ross as rs
    # and back: the rotor that ROSS has saved is the same, with the shear coefficient of its own formula
    rotor, _ = noted(rotid.to_ross, INPUT / "solid_rotor.inp")
    rotor.save(folder / "saved.json")
    again = rs.Rotor.load(folder / "saved.json")
    checks.close("to ROSS: a rotor that ROSS saved and loaded", [np.abs(again.K(0) - rotor.K(0)).max()], [0.0], 0, 1e-6 * np.abs(rotor.K(0)).max())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        modal = rotor.run_modal(speed=0, num_modes=40)
    lateral = np.abs(modal.modes[2::6]).max(axis=0) < np.abs(modal.modes[0::6]).max(axis=0) + np.abs(modal.modes[1::6]).max(axis=0)
    hz = np.sort(modal.evalues.imag[lateral]) / (2 * np.pi)
    out = export_of(INPUT / "solid_rotor.inp", folder)
    checks.close("to ROSS: run_modal", [hz[np.argmin(np.abs(hz - f))] for f in out["full_hz"][:3]], out["full_hz"][:3], 1e-5)
    deck = folder / "solid.inp"
    deck.write_text(STEEL + "*SHAFT, NAME=a, MATERIAL=steel\n0.4, 0.1, 0\n*SENSORS\n1, 0\n2, 0.2\n3, 0.4\n*FIT, MODEL=SOLID\n")
    refused(checks, "to ROSS: a solid", "is a solid, and ROSS has beam elements", rotid.to_ross, deck)


def draws(checks, folder):
    deck = INPUT / "solid_rotor.inp"
    fit = rotid.run("identify", deck, no_baseline=True)
    drawn = rotid.draws(fit, 20000, seed=3)
    names, table = list(drawn), np.array(list(drawn.values()))
    values, std = (np.array([p[key] for p in fit["parameters"]]) for key in ("value", "std"))
    checks.close("draws: mean", (table.mean(axis=1) - values) / std + 1, np.ones(2), 0.03)
    checks.close("draws: standard deviation", table.std(axis=1), std, 0.02)
    checks.close("draws: correlation", [np.corrcoef(table)[0, 1] + 2], [fit["correlation"][0, 1] + 2], 0.02)
    checks.true("draws: the same with the same seed", all(np.array_equal(v, rotid.draws(fit, 20000, seed=3)[n]) for n, v in drawn.items()), "")
    few = {name: v[:2] for name, v in drawn.items()}
    rotors = list(noted(rotid.stochastic, deck, few)[0])
    text = re.sub(r"FILE=", f"FILE={INPUT}/", deck.read_text())
    for i, rotor in enumerate(rotors):  # sheets across the axis: the shear coefficient moves with G
        by_hand = folder / "drawn.inp"
        by_hand.write_text(re.sub(r"(LAMINATED\n)[^,]*,[^,]*,", lambda m: f"{m[1]}{few['core.E'][i]!r}, {few['core.G'][i]!r},", text))
        out = export_of(by_hand, folder, start=True)
        k, m = (plane_of(rotor, (0, 4), part)[0] for part in (rotor.K(0), rotor.M()))
        hz = lowest_hz(k, m, len(out["rigid_hz"]) + len(out["full_hz"]))
        checks.close(f"draws: rotor {i + 1} of ROSS bends as the deck with these moduli", elastic(out, hz), out["full_hz"], EXACT)
    checks.true("draws: a rotor for each", len(rotors) == 2 and names == ["core.E", "core.G"], len(rotors))
    isotropic = folder / "isotropic.inp"  # whose fitted E is not the stated one, from which G goes with E all the same
    isotropic.write_text(STEEL + "*SHAFT, NAME=a, MATERIAL=steel\n0.4, 0.1, 0, 6\n*MODES, COUNT=ELASTIC\n1, 2500\n*IDENTIFY\na.E, 1e11, 4e11, 2e11\n")
    stiff = list(noted(rotid.stochastic, isotropic, {"a.E": np.array([1.5e11, 3e11])})[0])
    checks.close("draws: G of an isotropic material goes with E", [r.shaft_elements[0].material.E / r.shaft_elements[0].material.G_s for r in stiff],
                 [stiff[0].shaft_elements[0].material.E / stiff[0].shaft_elements[0].material.G_s] * 2, 1e-9)
    by_hand.write_text(isotropic.read_text().split("*MODES")[0].replace("2.1e11", "1.5e11"))
    out = export_of(by_hand, folder, start=True)
    k, m = (plane_of(stiff[0], (0, 4), part)[0] for part in (stiff[0].K(0), stiff[0].M()))
    checks.close("draws: and is that of the drawn E", elastic(out, lowest_hz(k, m, len(out["rigid_hz"]) + len(out["full_hz"]))), out["full_hz"], EXACT)
    shared = folder / "shared.inp"
    shared.write_text(STEEL + "*SHAFT, NAME=a, MATERIAL=steel\n0.4, 0.1, 0, 6\n*SHAFT, NAME=b, MATERIAL=steel\n0.3, 0.08, 0, 4\n"
                      "*MODES, COUNT=ELASTIC\n1, 900\n*IDENTIFY\na.E=b.E, 1e10, 9e11, 2e11\n")
    both = list(noted(rotid.stochastic, shared, {"a.E=b.E": np.array([1.5e11, 3e11])})[0])
    checks.close("draws: a shared unknown is drawn in each of its groups", [e.material.E for r in both for e in r.shaft_elements],
                 [1.5e11] * 10 + [3e11] * 10, 1e-9)
    refused(checks, "draws: a parameter that is no modulus", "tail.K", rotid.stochastic, deck, {"tail.K": [1.0]})
    bound = rotid.run("identify", folder / "bound.inp", no_baseline=True)
    refused(checks, "draws: a parameter at a bound", "a.E", rotid.draws, bound, 5)
    for count in (0, -1):
        refused(checks, f"draws: {count} of them", f"is {count}, expected at least 1", rotid.draws, fit, count)
    mass = {"name": "accelerometer.mass", "value": 0.02, "std": 0.03, "lower": 0.0, "upper": 0.06, "at_bound": False}
    drawn = rotid.draws({"parameters": [mass], "correlation": [[1.0]]}, 2000, seed=4)["accelerometer.mass"]
    checks.true("draws: none beyond a bound", drawn.size == 2000 and 0 <= drawn.min() < 0.002 and 0.058 < drawn.max() <= 0.06, (drawn.min(), drawn.max()))
    stiff_in_shear = folder / "stiff_in_shear.inp"  # whose fitted E, 0.14 of G, is none of a material of ROSS, and whose stated E is one
    stiff_in_shear.write_text(STEEL + "*MATERIAL, NAME=c\n*ELASTIC, TYPE=SHEAR\n1.2e11, 3e10, 0.3\n*DENSITY\n7600\n*SHAFT, NAME=l, MATERIAL=steel\n"
                              "0.3, 0.06, 0.01, 6\n*SHAFT, NAME=core, MATERIAL=c\n0.4, 0.12, 0.03, 8\n*SHAFT, NAME=r, MATERIAL=steel\n0.35, 0.05, 0, 7\n"
                              "*SPRING\n0.05, 2e7\n0.95, 3e7\n*DISK\n0.85, 5, 0.02, 0.04\n*MODES, COUNT=ALL\n1, 50\n*IDENTIFY\ncore.E, 1e9, 1e12, 1.2e11\n")
    fitted = rotid.run("identify", stiff_in_shear, no_baseline=True)["parameters"][0]["value"]
    checks.true("draws: E far below G", fitted < 6e9, fitted)
    refused(checks, "draws: a base without a material of ROSS", "core has no element of ROSS from z = 0.3 to 0.35 m", rotid.stochastic, stiff_in_shear,
            {"core.E": np.array([fitted, 0.9 * fitted])})
    gap = folder / "gap.inp"  # a joint in the only element of the group, whose moduli do not scale it
    gap.write_text(STEEL + "*SHAFT, NAME=a, MATERIAL=steel\n0.4, 0.1, 0, 1\n*SHAFT, NAME=b, MATERIAL=steel\n0.3, 0.08, 0, 3\n*CAUSE, NAME=gap, TYPE=joint, "
                   "BETWEEN=a,b\nflexibility, 2e-7\n*MODES, COUNT=ELASTIC\n1, 560\n*IDENTIFY\na.E, 1e10, 9e11, 2e11\n")
    refused(checks, "draws: a joint in an element", "a has no element of ROSS from z = 0 to 0.4 m", rotid.stochastic, gap, {"a.E": np.array([8e10, 9e10])})
    checks.true("to ROSS: matrices where it has no material", noted(rotid.to_ross, stiff_in_shear)[0] is not None, "")


# ---- from Nastran and Abaqus

BDF = """SOL 103
CEND
BEGIN BULK
MAT1,1,{e},,0.3,{rho}
PBARL,1,1,,ROD
,{r1}
PBEAML,2,1,,TUBE
,{r2},{i2}
PBAR,3,1,{a3},{j3},{j3},{p3}
GRID,1,,0.,0.,0.
GRID,2,,{x}.,0.,0.
GRID,3,,{y}.,0.,0.
GRID,4,,{z}.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
CBEAM,2,2,2,3,0.,1.,0.
CBAR,3,3,4,3,0.,1.,0.
CONM2,7,2,,{m},,,,+
+,{j},,{h},,,{h}
ENDDATA
"""
BY_HAND = STEEL + """*SHAFT, NAME=a, MATERIAL=steel
0.3, 0.1, 0, 1
0.4, 0.16, 0.04, 1
0.3, 0.08, 0.02, 1
*DISK, NAME=d
0.3, 5, 0.02, 0.03
"""


def bulk(**changed):
    a, j = math.pi / 4 * (80.0**2 - 20.0**2), math.pi / 64 * (80.0**4 - 20.0**4)
    values = {"e": "2.1+5", "rho": "7.85-9", "r1": "50.", "r2": "80.", "i2": "20.", "a3": f"{a:.8f}", "j3": f"{j:.6f}", "p3": f"{2 * j:.6f}", "x": 300, "y": 700,
              "z": 1000, "m": ".005", "j": "30.", "h": "20.", **changed}
    return BDF.format(**values)


def from_nastran(checks, folder):
    path, deck, hand = folder / "rotor.bdf", folder / "nastran.inp", folder / "hand.inp"
    hand.write_text(BY_HAND)
    path.write_text(bulk())
    written(rotid.from_nastran(path, units="MM"), deck)
    checks.close("from Nastran: frequencies of the deck by hand", bending_hz(deck), bending_hz(hand), 1e-6)
    checks.close("from Nastran: mass", [rotid.run("check", deck)["mass_kg"]], [rotid.run("check", hand)["mass_kg"]], 1e-7)
    checks.close("from Nastran: polar inertia", [rotid.run("check", deck)["geometry"]["disks"][0]["polar_kg_m2"]], [0.03], 1e-12)
    path.write_text(bulk().replace("PBEAML,2,1,,TUBE\n,80.,20.\n", "PBEAML,2,1,,ROD\n,80.,0.,NO,1.,50.\n"))
    said = written(rotid.from_nastran(path, units="MM"), deck)
    cone = [s["outer_m"] for g in rotid.run("check", deck)["geometry"]["groups"] for s in g["segments"]]
    checks.true("from Nastran: a tapered PBEAML is cylinders", len(cone) == 10 and cone[1] > cone[8] and not said, cone)
    path.write_text(bulk().replace("GRID,1,,0.,0.,0.", "GRID,1,,0.,0.,0.,,123456"))
    said = written(rotid.from_nastran(path, units="MM"), deck)
    checks.true("from Nastran: constraints of a GRID are said to be left out", any("PS of GRID" in s for s in said), said)
    a, i = math.pi * 80**2, math.pi / 4 * 80**4
    beside = f"PBEAM,2,1,{a:.6f},{i:.4f},{i:.4f},,{2 * i:.4f},,+\n+,,,,,,,,,+\n+,1.,1.,,,,,,,+\n+,,,,,5.\n"
    wrong = {
        "a neutral axis beside the nodes": (bulk().replace("PBEAML,2,1,,TUBE\n,80.,20.\n", beside), "PBEAM 2: its neutral axis"),
        "a station that is no end": (bulk().replace("PBEAML,2,1,,TUBE\n,80.,20.\n", "PBEAML,2,1,,ROD\n,80.,0.,NO,0.5,50.\n"), "PBEAML 2: has stations at [0.0, 0.5]"),
        "an offset": (bulk().replace("CBAR,1,1,1,2,0.,1.,0.", "CBAR,1,1,1,2,0.,1.,0.,,+\n+,,,0.,5."), "CBAR 1: wa"),
        "a pin": (bulk().replace("CBAR,1,1,1,2,0.,1.,0.", "CBAR,1,1,1,2,0.,1.,0.,,+\n+,5"), "CBAR 1: pin flags"),
        "a node beside the axis": (bulk().replace("GRID,2,,300.,0.", "GRID,2,,300.,9."), "beside the axis"),
        "a gap": (bulk().replace("CBEAM,2,2,2,3,0.,1.,0.\n", ""), "CBAR 3: it begins 0.7 m from the left end"),
        "a section that is not round": (bulk().replace("PBARL,1,1,,ROD\n,50.", "PBARL,1,1,,BAR\n,50.,20."), "PBARL 1: is a BAR section"),
        "inertias of no circle": (bulk(j3="1.0", p3="2.0"), "PBAR 3: has I1"),
        "no density": (bulk(rho=""), "MAT1 1: RHO is"),
        "another element": (bulk().replace("ENDDATA", "CROD,9,1,1,2\nENDDATA"), "CROD: 1 of them"),
        "parts that nothing joins": (bulk().replace("GRID,4,", "GRID,5,,700.,0.,0.\nGRID,4,").replace("CBAR,3,3,4,3,", "CBAR,3,3,4,5,"), "its node 5 lies where node 3 is"),
        "a mass beside the elements": (bulk().replace("GRID,4,", "GRID,5,,500.,0.,0.\nGRID,4,").replace("CONM2,7,2,", "CONM2,7,5,"), "CONM2 7: node 5 belongs to no beam element"),
        "a grid that is not there": (bulk().replace("GRID,4,,1000.,0.,0.\n", ""), "GRID 4 is not there"),
        "a property that is not there": (bulk().replace("CBAR,1,1,", "CBAR,1,8,"), "CBAR 1: property 8 is not there"),
        "a factor on all masses": (bulk().replace("BEGIN BULK", "BEGIN BULK\nPARAM,WTMASS,.00259"), "PARAM WTMASS: multiplies all masses by 0.00259"),
        "a factor on all masses in the case control": (bulk().replace("BEGIN BULK", "SUBCASE 1\n PARAM,GRDPNT,0\n PARAM,WTMASS,.00259 $ inch\n PARAM,K6ROT,1.\nBEGIN BULK"),
                                                       "PARAM WTMASS: multiplies all masses by .00259"),
        "a factor in the case control beside one of 1": (bulk().replace("BEGIN BULK", "PARAM,WTMASS,.5\nBEGIN BULK\nPARAM,WTMASS,1.0"), "PARAM WTMASS: multiplies all masses by .5"),
        "a part by itself": (bulk().replace("CBAR,3,3,4,3,", "BEGIN SUPER=1\nCBAR,3,3,4,3,"), "BEGIN SUPER=1: begins a part"),
        "a place that is no number": (bulk().replace("GRID,2,,300.,", "GRID,2,,nan,"), "GRID 2: is at [nan, 0.0, 0.0]"),
        "no bulk data": ("hello world, this is no deck\n", str(path)),
    }
    for name, (text, part) in wrong.items():
        path.write_text(text)
        refused(checks, f"from Nastran: {name}", part, rotid.from_nastran, path, place=path, units="MM")
    refused(checks, "from Nastran: no file", "cannot be read", rotid.from_nastran, folder / "absent.bdf", place="absent.bdf")


ABAQUS = """*HEADING
a rotor
*NODE, NSET=ALL
1, 0., 0., 0.
2, 0., 0., 0.3
3, 0., 0., 0.7
4, 0., 0., 1.0
*ELEMENT, TYPE=B31, ELSET=LEFT
1, 1, 2
*ELEMENT, TYPE=B31
2, 2, 3
3, 3, 4
*ELSET, ELSET=TUBE, GENERATE
2, 2, 1
*ELSET, ELSET=RIGHT
3,
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E11, 0.3
*DENSITY
7850.,
*BEAM SECTION, ELSET=LEFT, MATERIAL=STEEL, SECTION=CIRC
0.10, 0.10
1., 0., 0.
*BEAM SECTION, ELSET=TUBE, MATERIAL=STEEL, SECTION=PIPE
0.08, 0.06
*BEAM SECTION, ELSET=RIGHT, MATERIAL=STEEL, SECTION=PIPE
0.04, 0.03
*ELEMENT, TYPE=MASS, ELSET=HUB
10, 2
*MASS, ELSET=HUB
5.
*ELEMENT, TYPE=ROTARYI, ELSET=HUBI
11, 2
*ROTARY INERTIA, ELSET=HUBI
0.02, 0.02, 0.03
*ELEMENT, TYPE=SPRING1, ELSET=SUPPORT
12, 1
*SPRING, ELSET=SUPPORT
1
1e6
*STEP
*FREQUENCY
10
*END STEP
"""


def from_abaqus(checks, folder):
    path, deck, hand = folder / "rotor_abaqus.inp", folder / "abaqus.inp", folder / "hand.inp"
    hand.write_text(BY_HAND + "*SPRING, NAME=s\nstart, 1e6\n")
    path.write_text(ABAQUS)
    said = written(rotid.from_abaqus(path), deck)
    checks.close("from Abaqus: frequencies of the deck by hand", bending_hz(deck), bending_hz(hand), 1e-12)
    checks.true("from Abaqus: nothing is left out", not said, said)
    for name, twice in {"a set that names its element twice": ("*MASS, ELSET=HUB", "*ELSET, ELSET=HUB\n10\n*MASS, ELSET=HUB"),
                        "a set of sets of sets": ("*MASS, ELSET=HUB", "*ELSET, ELSET=S0\n10\n" + "".join(
                            f"*ELSET, ELSET=S{i + 1}\n{', '.join([f'S{i}'] * 16)}\n" for i in range(8)) + "*MASS, ELSET=S8"),
                        "a set to the last number": ("*ELEMENT, TYPE=MASS, ELSET=HUB\n", "*ELSET, ELSET=HUB, GENERATE\n" + "10, 999999999, 999\n" * 9 +
                                                     "*ELEMENT, TYPE=MASS\n"),
                        "a keyword line that goes on": ("*BEAM SECTION, ELSET=LEFT, MATERIAL=STEEL", "*BEAM SECTION,\n** a comment\n ELSET = LEFT ,\nMATERIAL=STEEL"),
                        "a node twice at one place": ("*ELEMENT, TYPE=MASS", "*NODE\n2, 0., 0., 0.3\n*ELEMENT, TYPE=MASS"),
                        "a set before its elements": ("*ELEMENT, TYPE=MASS, ELSET=HUB\n", "*ELSET, ELSET=HUB, GENERATE\n10, 10\n*ELEMENT, TYPE=MASS\n")}.items():
        path.write_text(ABAQUS.replace(*twice))
        written(rotid.from_abaqus(path), deck)
        checks.close(f"from Abaqus: {name}", [rotid.run("check", deck)["mass_kg"]], [rotid.run("check", hand)["mass_kg"]], 1e-12)
    text = ABAQUS.replace("*STEP", "*BOUNDARY\n1, 1, 3\n*STEP")
    path.write_text(text.replace("2.1E11, 0.3", "2.1E5, 0.3").replace("7850.,", "7.85E-9").replace("0.10, 0.10", "50.").replace("0.08, 0.06", "80., 60.")
                    .replace("0.04, 0.03", "40., 30.").replace("0.3\n3", "300.\n3").replace("0.7\n", "700.\n").replace("1.0\n*", "1000.\n*")
                    .replace("\n5.\n", "\n5e-3\n").replace("0.02, 0.02, 0.03", "20., 20., 30.").replace("1e6", "1e3"))
    said = written(rotid.from_abaqus(path, units="MM"), deck)
    checks.close("from Abaqus in mm: frequencies", bending_hz(deck), bending_hz(hand), 1e-12)
    checks.true("from Abaqus in mm: the density has its digits", "\n7850.0\n" in deck.read_text(), deck.read_text()[:400])
    checks.true("from Abaqus: *BOUNDARY is said to be left out", any("BOUNDARY" in s for s in said), said)
    path.write_text(ABAQUS.replace("2.1E11, 0.3", "2.1E11, 0.3, 20.\n1.6E11, 0.3, 500."))
    said = written(rotid.from_abaqus(path), deck)
    checks.true("from Abaqus: the temperature of E is said", any("of E at 2 temperatures the first one, 2.1e+11, is taken" in s for s in said), said)
    path.write_text(ABAQUS.replace("7850.,", "78500.,"))
    said = written(rotid.from_abaqus(path), deck)
    checks.true("from Abaqus: a density of other units is said", any("as a deck: density" in s for s in said), said)
    path.write_text(ABAQUS.replace("*FREQUENCY", "*BOUNDARY\n1, 1, 3\n*FREQUENCY"))
    said = written(rotid.from_abaqus(path), deck)
    checks.true("from Abaqus: *BOUNDARY of a step is said to be left out", any("BOUNDARY" in s for s in said), said)
    sheets = ABAQUS.replace("*ELASTIC\n2.1E11, 0.3", "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n2.1E11, 5E10, 5E10, .3, .3, .3, 3E10, 3E10\n2E10")
    along_x = re.sub(r"(?m)^(\d), 0., 0., (\S+)$", r"\1, \2, 0., 0.", sheets).replace("0.02, 0.02, 0.03", "0.03, 0.02, 0.02").replace("SUPPORT\n1\n", "SUPPORT\n2\n")
    path.write_text(along_x)
    written(rotid.from_abaqus(path), deck)
    got = rotid.run("check", deck)["geometry"]["groups"][0]["material"]
    checks.true("from Abaqus: E1 and G12 of a rotor along axis 1", got["e_pa"] == 2.1e11 and got["g_pa"] == 3e10, got)
    wrong = {
        "sheets across another axis": (sheets, "line 18: *ELASTIC: is of the axes of the file"),
        "sheets of two shear moduli": (along_x.replace("3E10, 3E10", "3E10, 2E10"), "line 19: *ELASTIC: G12 is 3e+10 and G13 2e+10"),
        "lines of another file": (ABAQUS.replace("*ELEMENT, TYPE=MASS, ELSET=HUB\n10, 2", "*ELSET, ELSET=HUB\n*ELEMENT, TYPE=MASS, ELSET=HUB, INPUT=hub.inp"), "INPUT=hub.inp is another file"),
        "a spring aslant": (re.sub(r"(?m)^(\d), 0., 0., (\S+)$", r"\1, \2, 0., \2", ABAQUS).replace("SUPPORT\n1\n", "SUPPORT\n3\n").replace("0.02, 0.02, 0.03", "0.02, 0.02, 0.02"),
                            "acts on degree of freedom 3"),
        "another element": (ABAQUS.replace("TYPE=B31, ELSET=LEFT", "TYPE=B32, ELSET=LEFT"), "line 8: *ELEMENT: TYPE=B32"),
        "a stress at the start": (ABAQUS.replace("*STEP", "*INITIAL CONDITIONS, TYPE=STRESS\nLEFT, 1e7\n*STEP"), "*INITIAL CONDITIONS: TYPE=STRESS changes the frequencies"),
        "a card that it does not know": (ABAQUS.replace("*STEP", "*EQUATION\n1\n*STEP"), "*EQUATION: has no place in a deck"),
        "a section that is not round": (ABAQUS.replace("SECTION=CIRC", "SECTION=RECT"), "line 22: *BEAM SECTION: SECTION=RECT is not round"),
        "an ellipse": (ABAQUS.replace("0.10, 0.10", "0.10, 0.08"), "line 23: *BEAM SECTION: has the diameters"),
        "a wall above the radius": (ABAQUS.replace("0.08, 0.06", "0.08, 0.09"), "line 26: *BEAM SECTION: has the outer radius"),
        "a node that is no number": (ABAQUS.replace("2, 0., 0., 0.3", "2, 0., 0., x"), "line 5: *NODE: z is 'x'"),
        "a node that is a number to Python alone": (ABAQUS.replace("2, 0., 0., 0.3", "2, 0., 0., 0_3"), "line 5: *NODE: z is '0_3'"),
        "a node with a raised two": (ABAQUS.replace("2, 0., 0., 0.3", "\xb2, 0., 0., 0.3"), "line 5: *NODE: the node is "),
        "a section beside its nodes": (ABAQUS.replace("SECTION=CIRC", "SECTION=CIRC, OFFSET1=0.5"), "line 22: *BEAM SECTION: OFFSET1 puts it beside"),
        "a node 1e999": (ABAQUS.replace("2, 0., 0., 0.3", "2, 0., 0., 1e999"), "line 5: *NODE: z is '1e999'"),
        "a node that is not there": (ABAQUS.replace("3, 3, 4\n*ELSET", "3, 3, 9\n*ELSET"), "line 12: node 9 of element 3 is not there"),
        "an element without a section": (ABAQUS.replace("*BEAM SECTION, ELSET=RIGHT, MATERIAL=STEEL, SECTION=PIPE\n0.04, 0.03\n", ""), "element 3 has no *BEAM SECTION"),
        "a material without density": (ABAQUS.replace("*DENSITY\n7850.,\n", ""), "line 17: *MATERIAL, NAME=STEEL has no *DENSITY"),
        "a material that is not there": (ABAQUS.replace("ELSET=LEFT, MATERIAL=STEEL", "ELSET=LEFT, MATERIAL=IRON"), "the material IRON is not there"),
        "a spring along the axis": (ABAQUS.replace("\n1\n1e6", "\n3\n1e6"), "acts on degree of freedom 3"),
        "a spring by a curve": (ABAQUS.replace("ELSET=SUPPORT\n1\n1e6", "ELSET=SUPPORT, NONLINEAR\n1\n0., 0.\n1e3, 1e-3"), "expected a degree of freedom and one stiffness"),
        "a part": (ABAQUS.replace("*NODE", "*PART, NAME=P\n*NODE"), "line 3: *PART: has no place"),
        "a mass without its card": (ABAQUS.replace("*MASS, ELSET=HUB\n5.\n", ""), "line 30: element 10 has no *MASS"),
        "a spring without its card": (ABAQUS.replace("*SPRING, ELSET=SUPPORT\n1\n1e6\n", ""), "element 12 has no *SPRING"),
        "a mass stated twice": (ABAQUS.replace("*MASS, ELSET=HUB\n5.", "*MASS, ELSET=HUB\n5.\n*MASS, ELSET=HUB\n5."), "element 10 has a *MASS already"),
        "a mass of three directions": (ABAQUS.replace("*MASS, ELSET=HUB\n5.", "*MASS, ELSET=HUB, TYPE=ANISOTROPIC\n5., 1., 2."), "*MASS: TYPE=ANISOTROPIC"),
        "a mass beside the elements": (ABAQUS.replace("1.0\n*", "1.0\n5, 0., 0., 0.5\n*", 1).replace("10, 2\n", "10, 5\n"), "node 5 belongs to no beam element"),
        "parts that nothing joins": (ABAQUS.replace("1.0\n*", "1.0\n5, 0., 0., 0.7\n*", 1).replace("3, 3, 4", "3, 5, 4"), "node 5 lies where node 3 is"),
        "a node at two places": (ABAQUS.replace("*ELEMENT, TYPE=MASS", "*NODE\n2, 0., 0., 0.31\n*ELEMENT, TYPE=MASS"), "line 30: *NODE: node 2 is another place in line 5"),
        "a material twice": (ABAQUS.replace("*BEAM SECTION, ELSET=LEFT", "*MATERIAL, NAME=Steel\n*BEAM SECTION, ELSET=LEFT"), "*MATERIAL: STEEL occurs twice, first in line 17"),
        "a material of two moduli": (ABAQUS.replace("*DENSITY", "*ELASTIC\n2E11, 0.3\n*DENSITY"), "line 20: *ELASTIC: the material STEEL has one already"),
        "data behind a comma": (ABAQUS.replace("*DENSITY\n", "*DENSITY,\n"), "line 21: *DENSITY: '7850.' is no option"),
        "a node in cylindrical coordinates": (ABAQUS.replace("NSET=ALL", "NSET=ALL, SYSTEM=C"), "line 3: *NODE: SYSTEM=C"),
        "no cards": ("nothing\n", "line 1: 'nothing' belongs to no card"),
    }
    for name, (changed, part) in wrong.items():
        path.write_text(changed)
        refused(checks, f"from Abaqus: {name}", part, lambda p: rotid.write_deck(rotid.from_abaqus(p), folder / "no.inp"), path, place=path)
    # a slender free beam of 60 elements is Euler's: cosh x cos x = 1
    nodes = "".join(f"{i + 1}, {4.0 * i / 60!r}, 0, 0\n" for i in range(61))
    path.write_text(f"*NODE\n{nodes}*ELEMENT, TYPE=B31, ELSET=A\n" + "".join(f"{i}, {i}, {i + 1}\n" for i in range(1, 61)) +
                    "*MATERIAL, NAME=S\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*BEAM SECTION, ELSET=A, MATERIAL=S, SECTION=CIRC\n0.002\n")
    written(rotid.from_abaqus(path), deck)
    root = [brentq(lambda x: math.cos(x) - 1 / math.cosh(x), a, b) for a, b in ((4, 5), (7, 8), (10, 11.5))]
    euler = [x**2 / (2 * math.pi * 16) * math.sqrt(2.1e11 * 0.004**2 / 16 / 7850) for x in root]
    checks.close("from Abaqus: a slender beam", bending_hz(deck)[:3], euler, 3e-5)


def main():
    checks = Checks()
    os.environ["ROTID"] = PROGRAM
    from export_peer import import_ross

    import_ross()
    with temporary_folder() as name:
        folder = Path(name)
        commands(checks, folder)
        from_ross_refuses(checks, folder)
        from_ross_means(checks, folder)
        decks_are_whole(checks, folder)
        from_ross_bends(checks, folder)
        to_ross_bends(checks, folder)
        to_ross_whirls(checks, folder)
        draws(checks, folder)
        from_nastran(checks, folder)
        from_abaqus(checks, folder)
    checks.end()


if __name__ == "__main__":
    main()

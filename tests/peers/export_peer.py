"""What rotid export writes, read by the programs it is for: Matrix Market by SciPy, DMIG by pyNastran. Each has the frequencies that rotid
itself computes; the whole of the matrices is compared between the formats. python_peer.py takes its decks from here."""
import importlib
import math
import os
import re
import sys
import warnings
from pathlib import Path

import numpy as np
from pyNastran.bdf.bdf import read_bdf
from scipy.io import mmread
from scipy.linalg import eigh

from support import INPUT, Checks, parse, result, rotid, temporary_folder

EXACT = 1e-9  # the same matrices, solved by somebody else

STEEL = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
CORE = "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n1.1e11, 0.35e11, 0.28\n*DENSITY\n7600\n"
SHAFT = """*SHAFT, NAME=left, MATERIAL=steel
0.25, 0.08, 0.02, 8
*SHAFT, NAME=core, MATERIAL=sheets
0.50, 0.20, 0.05, 20
*SHAFT, NAME=right, MATERIAL=steel
0.25, 0.09, 0, 8
"""
SENSORS = "*SENSORS\n" + "".join(f"{10 + i}, {i / 20}\n" for i in range(21))
SUPPORTS = "*SPRING, NAME=a\nstart, 2e5, 3e3\n*SPRING\nend, 1e5\n"
DECKS = {
    "free, hollow, no sensors": STEEL + CORE + SHAFT,
    "perforated, stiffness diameter": STEEL + CORE + SHAFT.replace("0.25, 0.09, 0, 8", "0.25, 0.09, 0, 8, 0.08")
    + "*PERFORATION, GROUP=core\n12, 0.02, 0.06\n" + SUPPORTS + SENSORS,
    "thin ring of holes near the rim": STEEL + CORE + SHAFT.replace("0.20, 0.05", "0.20, 0") + "*PERFORATION, GROUP=core\n24, 0.014, 0.088\n" + SENSORS,
    "rods, disks, springs, preload": STEEL + CORE + SHAFT + "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n8, 0.016, 0.07, 40e3\n"
    "*DISK, NAME=fan\n0.9, 6, 0.02, 0.04\n*PRELOAD, GROUP=left\n-2e4\n" + SUPPORTS + SENSORS,
    "rods of four elements, bars": STEEL + CORE + SHAFT + "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n8, 0.016, 0.07, 40e3, 4\n"
    "*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.4\n12, 0.012, 0.08, 8\n" + SUPPORTS + SENSORS,
    "joint, masses, gradient, sling": STEEL + CORE + SHAFT + "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n8, 0.016, 0.07, 40e3\n"
    "*CAUSE, NAME=gap, TYPE=joint, BETWEEN=core,right\nflexibility, 2e-7\n*CAUSE, NAME=ring, TYPE=added_mass\nmass, 0.7\nz, 0.333\n"
    "*CAUSE, NAME=cube, TYPE=added_mass\nmass, 0.4\nz, 0.05\n*CAUSE, NAME=slope, TYPE=stiffness_gradient, GROUP=core\nslope, 0.2\n*SLING, LENGTH=1.5\n" + SENSORS,
}
POLAR = {  # kg.m2: rho times the integral of r^2 over all that turns, by hand
    "perforated, stiffness diameter": lambda: disc(7850, 0.25, 0.08, 0.02) + disc(7600, 0.5, 0.2, 0.05)
    - 7600 * 0.5 * 12 * math.pi * 0.01**2 * (0.06**2 + 0.02**2 / 8) + disc(7850, 0.25, 0.09, 0),
    "rods, disks, springs, preload": lambda: disc(7850, 0.25, 0.08, 0.02) + disc(7600, 0.5, 0.2, 0.05) + disc(7850, 0.25, 0.09, 0)
    + 7850 * 0.5 * 8 * math.pi * 0.008**2 * (0.07**2 + 0.016**2 / 8) + 0.04,
    "rods of four elements, bars": lambda: disc(7850, 0.25, 0.08, 0.02) + disc(7600, 0.5, 0.2, 0.05) + disc(7850, 0.25, 0.09, 0)
    + 7850 * 0.5 * 8 * math.pi * 0.008**2 * (0.07**2 + 0.016**2 / 8) + 7850 * 0.4 * 12 * math.pi * 0.006**2 * (0.08**2 + 0.012**2 / 8),
    "joint, masses, gradient, sling": lambda: disc(7850, 0.25, 0.08, 0.02) + disc(7600, 0.5, 0.2, 0.05) + disc(7850, 0.25, 0.09, 0)
    + 7850 * 0.5 * 8 * math.pi * 0.008**2 * (0.07**2 + 0.016**2 / 8),
}


def import_ross():
    """ROSS, without what one of its dependencies prints from C about a library that it does not find."""
    sys.stdout.flush()
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        importlib.import_module("ross")
    os.dup2(kept, 1)
    os.close(kept)
    os.close(nothing)


def disc(rho, length, outer, inner):
    return rho * length * math.pi / 32 * (outer**4 - inner**4)


def lowest_hz(stiffness, mass, count):
    """The lowest frequencies from M phi = mu (K + s M) phi, whose rounding is relative to them and not to the highest."""
    shift = (2 * math.pi * 100) ** 2
    n = mass.shape[0]
    mu = eigh(mass, stiffness + shift * mass, eigvals_only=True, subset_by_index=(max(n - count, 0), n - 1))[::-1]
    return np.sqrt(np.maximum(1 / mu - shift, 0)) / (2 * math.pi)


def exported(checks, deck, kind, target, *options, expected=(0,)):
    """The JSON of an export, whose files are there."""
    out = result("export", deck, "--format", kind, "-o", str(target), *options, expected=expected)
    missing = [name for name in out["files"] if not Path(name).exists()]
    checks.true(f"{deck.name}: {kind} {' '.join(options)} wrote {len(out['files'])} file(s)", not missing, missing)
    return out


def elastic(out, hz):
    return hz[len(out["rigid_hz"]):]


def compare_bending(checks, name, out, hz, expected):
    checks.close(name, elastic(out, hz)[:len(expected)], expected, EXACT)


def matrix_market(checks, deck, folder, full_hz, reduced_hz, *options, expected=(0,)):
    out = exported(checks, deck, "matrix-market", folder / "mm", *options, expected=expected)
    matrices = {name: mmread(folder / f"mm.{name}.mtx") for name in ("stiffness", "mass")}
    k, m = (matrices[name].toarray() for name in ("stiffness", "mass"))
    count = len(out["rigid_hz"]) + len(full_hz)
    compare_bending(checks, f"{deck.name}: eigh of the .mtx files, as rotid", out, lowest_hz(k, m, count), full_hz)
    nodes = np.genfromtxt(folder / "mm.nodes.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    checks.true(f"{deck.name}: one line of nodes.csv for every node", 2 * len(nodes) == k.shape[0], len(nodes))
    lateral, turning = nodes["row_v"] - 1, nodes["row_theta"] - 1
    shift = np.zeros(k.shape[0])
    shift[lateral] = 1
    checks.close(f"{deck.name}: mass by a rigid translation", [shift @ m @ shift], [out["mass_kg"]], 1e-10)
    tilt = np.zeros(k.shape[0])
    tilt[lateral], tilt[turning] = nodes["z_m"], -1
    checks.close(f"{deck.name}: centre of mass by a rigid rotation", [tilt @ m @ shift / out["mass_kg"]], [out["center_of_mass_m"]], 1e-10)
    if reduced_hz is not None:
        kc, mc = (np.asarray(mmread(folder / f"mm.condensed_{name}.mtx")) for name in ("stiffness", "mass"))
        checks.true(f"{deck.name}: a row for every sensor", kc.shape == (out["masters"],) * 2 and out["masters"] == sum(nodes["sensor"] > 0), kc.shape)
        compare_bending(checks, f"{deck.name}: eigh of the condensed .mtx files, as rotid", out,
                        lowest_hz(kc, mc, len(out["rigid_hz"]) + len(reduced_hz)), reduced_hz)
        return k, m, kc, mc
    return k, m, None, None


def dmig_matrix(model, key, order):
    """What case control selects by K2GG or M2GG, factors times matrices, in the order of (grid, component)."""
    total = np.zeros((len(order), len(order)))
    for factor, name in model.case_control_deck.subcases[0].get_parameter(key)[0]:
        part, rows, columns = model.dmig[name].get_matrix(is_sparse=False)
        i = [order[rows[r]] for r in range(part.shape[0])]
        j = [order[columns[c]] for c in range(part.shape[1])]
        total[np.ix_(i, j)] += factor * part
    return total


def dmig(checks, deck, folder, k, m, kc, mc, *options, expected=(0,)):
    for condensed, stiffness, mass in ((False, k, m), (True, kc, mc)):
        if stiffness is None:
            continue
        path = folder / "model.bdf"
        out = exported(checks, deck, "dmig", path, *options, *(("--condensed",) if condensed else ()), expected=expected)
        model = read_bdf(path, xref=False, debug=None)
        grids = sorted(model.nodes, key=lambda g: (model.nodes[g].xyz[2], g)) if condensed else sorted(model.nodes)
        components = (1,) if condensed else (1, 5)
        order = {(g, c): len(components) * i + components.index(c) for i, g in enumerate(grids) for c in components}
        sign = np.ones(len(order)) if condensed else np.tile([1.0, -1.0], len(grids))  # R2 = dv/dz = -theta
        found_k, found_m = (dmig_matrix(model, key, order) * np.outer(sign, sign) for key in ("K2GG", "M2GG"))
        what = "condensed DMIG" if condensed else "DMIG"
        checks.true(f"{deck.name}: {what} holds K to the last bit", np.array_equal(found_k, stiffness), np.abs(found_k - stiffness).max())
        checks.true(f"{deck.name}: {what} holds M to the last bit", np.array_equal(found_m, mass), np.abs(found_m - mass).max())
        hz = lowest_hz(found_k, found_m, len(out["rigid_hz"]) + len(out["exported_hz"]))
        compare_bending(checks, f"{deck.name}: eigh of the {what}, as rotid", out, hz, [f for f in out["exported_hz"] if f is not None])
        held = {(g, int(c)) for spc in model.spcs[1] for g in spc.nodes for c in spc.components}
        free = {(g, c) for g in model.nodes for c in range(1, 7)} - held
        checks.true(f"{deck.name}: {what} holds all that has no stiffness", free == set(order), sorted(free ^ set(order))[:4])
        checks.true(f"{deck.name}: {what} asks for these modes", model.methods[1].nd == len(out["rigid_hz"]) + len(out["exported_hz"]), "")


def identified(checks, folder):
    """Decks that are fitted first: the reference is what rotid identify predicts."""
    for name, code in (("paper_rotor.inp", (0,)), ("solid_rotor.inp", (0, 1)), ("brake_reuss_beam.inp", (0, 1))):
        deck = INPUT / name
        fit = result("identify", deck, "--no-baseline", expected=code)
        predicted = [mode["predicted_hz"] for mode in sorted(fit["modes"], key=lambda mode: mode["mode"])]
        full = parse((folder / "full.json").read_text())["full_hz"] if rotid("export", deck, "--format", "matrix-market", "-o", folder / "full",
                                                                            "--json", folder / "full.json", "--quiet")[0] in code else []
        reduced = fit["reduction"] != "NONE"
        if not reduced:
            checks.close(f"{name}: exported frequencies are those of identify", full[:len(predicted)], predicted, EXACT)
        matrices = matrix_market(checks, deck, folder, full, predicted if reduced else None, expected=code)
        if not reduced:
            matrices = (*matrices[:2], *(np.asarray(mmread(folder / f"mm.condensed_{part}.mtx")) for part in ("stiffness", "mass")))
        dmig(checks, deck, folder, *matrices, expected=code)
        out = parse((folder / "full.json").read_text())
        checks.close(f"{name}: exported parameters are those of identify", [p["value"] for p in out["parameters"]],
                     [p["value"] for p in fit["parameters"]], 1e-14)


def stated(checks, folder):
    for name, text in DECKS.items():
        deck = folder / (re.sub(r"\W+", "_", name) + ".inp")
        deck.write_text(text)
        modes = result("modes", deck)
        full, reduced = ([mode[key] for mode in modes["modes"]] for key in ("full_hz", "reduced_hz"))
        matrices = matrix_market(checks, deck, folder, full, reduced if "*SENSORS" in text else None)
        dmig(checks, deck, folder, *matrices)


def main():
    checks = Checks()
    with temporary_folder() as folder:
        identified(checks, Path(folder))
        stated(checks, Path(folder))
    checks.end()


if __name__ == "__main__":
    main()

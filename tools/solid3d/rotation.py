#!/usr/bin/env python3
"""The whirl of a thick disk on a shaft by bricks in rotation, beside rotid with MODEL=SOLID. Called from the root of the sources:
tools/solid3d/rotation.py ROTID [RAD_PER_S]. CalculiX solves a static step under the centrifugal force, the modes about it and the
complex frequencies with Coriolis forces, all in the rotating frame: frequencies of the fixed frame are those plus (forward) or less
(backward) the speed. That has the terms in the square of the speed, stress and softening, which rotid leaves out. Bricks at the
corners of the disk are too stiff: two meshes are extrapolated, and frequencies in rotation taken over those at rest of the same program."""
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
import ccx
import deck as decks
import mesh as meshes

DECK = Path(__file__).parent / "thick_disk.inp"
LARGEST, MODES = 0.06, 3
CORNERS = (0.03, 0.015)  # m, of the bricks at the corners of the disk; errors of frequencies fall with h^1.089 there
RATIO = 0.5**1.089
SPLIT = 0.3  # %, of the difference of forward and backward over the frequency at rest
SMALL = 0.01  # %, of the frequency at rest: what a split that small may differ by
ALONE, HARMONIC_0 = {"torsion": 4 / 3, "axial": 1.089}, 0.3  # exponents of the error at the corners; %
SQUARES = 0.1  # %, of the mean of both, where terms in the square of the speed would show


def whole(quarter):
    """Nodes and bricks of the whole circle, of which the quarter is turned."""
    nodes, number, bricks = [], {}, []
    for turn in range(4):
        c, s = [(1, 0), (0, 1), (-1, 0), (0, -1)][turn]
        own = []
        for x, y, z in quarter.nodes:
            at = (c * x - s * y, s * x + c * y, z)
            key = tuple(round(v, 9) + 0.0 for v in at)
            if key not in number:
                nodes.append(at)
                number[key] = len(nodes)
            own.append(number[key])
        bricks += [[own[n] for n in brick] for group in quarter.bricks.values() for brick in group]
    return nodes, bricks


def shares_of_section(nodes, bricks, z):
    """Shares of the nodes at z in a stiffness spread evenly over that section, by the mass of eight-node faces (3/76 a corner, 16/76 a
    middle): all positive."""
    share = {}
    for brick in bricks:
        for face in ((0, 8, 1, 9, 2, 10, 3, 11), (4, 12, 5, 13, 6, 14, 7, 15)):
            around = [nodes[brick[i] - 1] for i in face]
            if all(abs(node[2] - z) < 1e-9 for node in around):
                area = abs(sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(around, around[1:] + around[:1]))) / 2
                for k, i in enumerate(face):
                    share[brick[i]] = share.get(brick[i], 0) + area * (16 if k % 2 else 3) / 76
    total = sum(share.values())
    return {n: w / total for n, w in share.items()}


def text_of(deck, bearings, nodes, bricks, speed, count, hold=1e6):
    """Springs across the axis are spread over their section: those of rotid move with its mean; one along the axis and a pair around it hold what a static step must not leave free."""
    (name, m), = deck.materials.items()
    out = ["*NODE, NSET=ALL"] + [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(nodes, 1)]
    out.append("*ELEMENT, TYPE=C3D20R, ELSET=BODY")
    for i, brick in enumerate(bricks, 1):
        out += ccx.rows([i, *brick], 12)
    out += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{m.axial_e:.12e}, {m.plane_nu:.12e}", "*DENSITY", f"{m.rho:.12e}",
            f"*SOLID SECTION, ELSET=BODY, MATERIAL={name}"]
    last, key = len(bricks), {tuple(round(v, 9) + 0.0 for v in node): i for i, node in enumerate(nodes, 1)}

    def spring(kind, ends, dofs, stiffness):
        nonlocal last
        last += 1
        out.extend([f"*ELEMENT, TYPE={kind}, ELSET=S{last}", ", ".join(map(str, [last, *ends])), f"*SPRING, ELSET=S{last}",
                    ", ".join(map(str, dofs)), f"{stiffness:.12e}"])

    for z, stiffness in bearings:
        for n, share in shares_of_section(nodes, bricks, z).items():
            for dof in (1, 2):
                spring("SPRING1", [n], [dof], stiffness * share)
    radius = deck.sections[0].rings[-1][1]
    spring("SPRING1", [key[(0.0, 0.0, 0.0)]], [3], hold)
    spring("SPRING2", [key[(round(radius, 9), 0.0, 0.0)], key[(round(-radius, 9), 0.0, 0.0)]], [2, 2], hold)
    if speed:
        out += ["*STEP, NLGEOM", "*STATIC", "*DLOAD", f"BODY, CENTRIF, {speed**2:.12e}, 0., 0., 0., 0., 0., 1.", "*END STEP",
                "*STEP, PERTURBATION", "*FREQUENCY, STORAGE=YES", str(count), "*END STEP",
                "*STEP, PERTURBATION", "*COMPLEX FREQUENCY, CORIOLIS", str(count),
                "*DLOAD", f"BODY, CENTRIF, {speed**2:.12e}, 0., 0., 0., 0., 0., 1.", "*END STEP"]
    else:
        out += ["*STEP", "*FREQUENCY", str(count), "*END STEP"]
    return "\n".join(out) + "\n"


def solve(text, folder):
    """Lines of numbers of the last table of frequencies [rad/s]."""
    folder = Path(folder)
    (folder / "job.inp").write_text(text)
    one = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER"), "1")
    done = subprocess.run([ccx.PROGRAM, "-i", "job"], cwd=folder, env={**os.environ, **one}, capture_output=True, text=True)
    found, inside = [], False
    for line in (folder / "job.dat").read_text().splitlines():
        fields = line.split()
        if "E I G E N V A L U E" in line:
            found, inside = [], True
        elif "P A R T I C I P A T I O N" in line:
            inside = False
        elif inside and len(fields) in (4, 5) and fields[0].isdigit():  # number, eigenvalue where it is real, rad/s, Hz, imaginary part
            found.append(float(fields[-3]))
    if not found:
        raise RuntimeError(f"ccx: exit code {done.returncode}\n{done.stdout[-2000:]}")
    return found


def by_rotid(program, speed):
    rpm = speed * 30 / math.pi
    done = subprocess.run([program, "speeds", str(DECK), "--speeds", f"0,{rpm:.12g}", "--json", "-"], capture_output=True, text=True)
    at_rest, turning = json.loads(done.stdout)["campbell"]
    return [m["frequency_hz"] * 2 * math.pi for m in at_rest["modes"][::2]], {
        whirl: [m["frequency_hz"] * 2 * math.pi for m in turning["modes"] if m["whirl"] == whirl] for whirl in ("forward", "backward")}


def nearest(values, wanted):
    return min(values, key=lambda v: abs(v - wanted))


def whirls(still, moving, rest, forward, backward, speed):
    """At rest, forward and backward [rad/s] of the fixed frame; bricks of a coarse mesh are off by the same share in all three."""
    zero = nearest(still, rest)
    fixed = [abs(v + turn) for v in moving + [-v for v in moving] for turn in (speed, -speed)]
    return zero, nearest(fixed, forward * zero / rest), nearest(fixed, backward * zero / rest)


def alone(program, kind):
    """The first frequency of torsion or along the axis by rotid [rad/s]."""
    done = subprocess.run([program, "modes", str(DECK), "--type", kind, "--json", "-"], capture_output=True, text=True)
    return json.loads(done.stdout)["modes"][0]["full_hz"] * 2 * math.pi


def main():
    if not ccx.PROGRAM:
        print("skipped: ccx is not installed (Debian: calculix-ccx; tools/setup --developer)")
        return 0
    speed = float(sys.argv[2]) if len(sys.argv) > 2 else 1000.0
    deck = decks.read(str(DECK))
    ends, bearings = {"start": 0.0, "end": deck.length}, []
    for _, name, _, lines in decks.cards(str(DECK)):
        if name == "BEARING":
            bearings.append((ends[lines[0][1][0].lower()], float(lines[0][1][1])))
    rest, turning = by_rotid(sys.argv[1], speed)
    harmonic0 = {kind: alone(sys.argv[1], kind) for kind in ALONE}
    meshed, free = [], []
    for corner in CORNERS:
        nodes, bricks = whole(meshes.make(deck, LARGEST, corner))
        print(f"{len(nodes)} nodes, {speed:g} rad/s")
        with tempfile.TemporaryDirectory(prefix="rotation-") as folder:
            still = solve(text_of(deck, bearings, nodes, bricks, 0, 12), folder)
            moving = solve(text_of(deck, bearings, nodes, bricks, speed, 24), folder)
            loose = solve(text_of(deck, [(z, 1e3) for z, _ in bearings], nodes, bricks, 0, 18, 1e3), folder)
        free.append({kind: nearest(loose, value) for kind, value in harmonic0.items()})
        meshed.append([whirls(still, moving, rest[i], turning["forward"][i], turning["backward"][i], speed) for i in range(MODES)])
    failed = 0
    for i in range(MODES):
        zero, forward, backward = (fine + RATIO / (1 - RATIO) * (fine - coarse) for coarse, fine in zip(*(m[i] for m in meshed)))
        ours, theirs = [(f - b) / z for f, b, z in ((turning["forward"][i], turning["backward"][i], rest[i]), (forward, backward, zero))]
        means = [(f + b) / 2 / z for f, b, z in ((turning["forward"][i], turning["backward"][i], rest[i]), (forward, backward, zero))]
        for what, value, allowed in (("split", 100 * (ours / theirs - 1), max(SPLIT, SMALL / theirs)), ("mean", 100 * (means[0] / means[1] - 1), SQUARES)):
            good = abs(value) <= allowed
            failed += not good
            print("ok" if good else "FAILED", f"mode {i + 1}, {rest[i]:.2f} rad/s at rest (bricks {zero:.2f}), {turning['backward'][i]:.2f} and "
                  f"{turning['forward'][i]:.2f} (bricks {backward:.2f} and {forward:.2f}): {what} {value:+.3f} % (within {allowed:.2g})")
    for kind, value in harmonic0.items():
        ratio = 0.5 ** ALONE[kind]
        bricks = free[1][kind] + ratio / (1 - ratio) * (free[1][kind] - free[0][kind])
        good = abs(value / bricks - 1) <= HARMONIC_0 / 100
        failed += not good
        print("ok" if good else "FAILED", f"{kind} at rest {value:.2f} rad/s (bricks {bricks:.2f}): {100 * (value / bricks - 1):+.3f} % (within {HARMONIC_0})")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())

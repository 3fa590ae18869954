"""The machine in operation beside ROSS: eigenvalues at several speeds, unbalance response, and the time of a Campbell diagram. Elements,
disks and bearings of both are the same: consistent Timoshenko elements with Cowper's coefficient, lumped disks at nodes, eight
coefficients by rows. ROSS has torsion and axial motion too, whose modes are told apart by their vectors. Tables of bearings rise
linearly over speed, where the splines of ROSS and the straight lines of rotid are one."""
import math
import resource
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np

warnings.simplefilter("ignore")
import ross

from support import Checks, parse, temporary_folder

PROGRAM = str(Path(sys.argv[1]).resolve())
EXACT = 1e-5  # asked; elements agree to rounding, bases of modes in rotid are good to 1e-6
FASTER = 200
E, NU, RHO = 2.1e11, 0.3, 7810.0
ISOTROPIC, CROSS = [1e6, 0, 0, 1e6, 100, 0, 0, 100], [2e7, 6e6, -4e6, 3e7, 4e4, 1e3, 1e3, 5e4]
TABLE = np.array([0.0, 3000, 6000, 9000, 12000])  # rpm


def uniform(count, length, outer, inner=0.0):
    return [(length, outer, inner)] * count


# name, elements (length, outer, inner), disks (node, m, Id, Ip), bearings (node, eight coefficients at rest, at the end of the table or None),
# node with unbalance, highest speed [rpm]
ROTORS = [
    ("two disks", uniform(6, 0.25, 0.05), [(2, 32.59, 0.1781, 0.3293), (4, 63.72, 0.4, 0.75)], [(0, ISOTROPIC, None), (6, ISOTROPIC, None)], 2, 4000),
    ("overhung hollow", uniform(4, 0.1, 0.06, 0.02) + uniform(6, 0.12, 0.09, 0.03), [(10, 60.0, 0.9, 1.7)],
     [(1, [3e7, 0, 0, 5e7, 2e3, 0, 0, 3e3], None), (6, [5e7, 0, 0, 8e7, 2e3, 0, 0, 3e3], None)], 10, 9000),
    ("cross-coupled", uniform(8, 0.2, 0.1), [(3, 80.0, 1.2, 2.3), (5, 50.0, 0.7, 1.3)], [(0, CROSS, None), (8, CROSS, None)], 3, 9000),
    ("tables", uniform(10, 0.15, 0.12), [(4, 120.0, 2.0, 3.9), (7, 40.0, 0.5, 0.9)],
     [(1, [1e8, 2e7, -3e7, 2e8, 2e5, -3e4, -3e4, 4e5], [6e7, 4e7, -6e7, 9e7, 1e5, -1e4, -1e4, 2e5]),
      (9, [9e7, 2e7, -2e7, 1.6e8, 2e5, -2e4, -2e4, 3e5], [5e7, 3e7, -5e7, 8e7, 9e4, -1e4, -1e4, 2e5])], 4, 12000),
    ("many sections", [(l, d, 0.0) for l, d in zip(np.linspace(0.05, 0.12, 24), 0.08 + 0.22 * np.sin(np.linspace(0.2, 2.9, 24)))],
     [(0, 6.0, 0.02, 0.04), (12, 90.0, 1.5, 2.9), (24, 9.0, 0.05, 0.09)],
     [(3, [4e8, 0, 0, 3e8, 2e5, 0, 0, 1.5e5], None), (21, [4e8, 0, 0, 3e8, 2e5, 0, 0, 1.5e5], None)], 12, 12000)]


def deck_of(folder, case):
    name, elements, disks, bearings, unbalance, _ = case
    z = np.concatenate([[0], np.cumsum([e[0] for e in elements])])
    text = f"*MATERIAL, NAME=s\n*ELASTIC\n{E!r}, {NU!r}\n*DENSITY\n{RHO!r}\n*SHAFT, NAME=shaft, MATERIAL=s\n"
    text += "".join(f"{float(l)!r}, {float(o)!r}, {float(i)!r}, 1\n" for l, o, i in elements) + "*RUNNING\n"
    text += "".join(f"*DISK\n{z[n]:.15g}, {m!r}, {d!r}, {p!r}\n" for n, m, d, p in disks)
    for b, (node, rest, end) in enumerate(bearings):
        if end is None:
            text += f"*BEARING\n{z[node]:.15g}, " + ", ".join(repr(float(v)) for v in rest) + "\n"
            continue
        table = folder / f"{name.replace(' ', '_')}_{b}.csv"
        rows = [[rpm, *(np.array(rest) + (np.array(end) - rest) * rpm / TABLE[-1])] for rpm in TABLE]
        table.write_text("speed_rpm,kxx,kxy,kyx,kyy,cxx,cxy,cyx,cyy\n" + "".join(",".join(repr(float(v)) for v in row) + "\n" for row in rows))
        text += f"*BEARING, FILE={table}\n{z[node]:.15g}\n"
    text += f"*UNBALANCE\n{z[unbalance]:.15g}, 0.002, 25\n*PROBE, NAME=x\n{z[unbalance]:.15g}, 0\n*PROBE, NAME=y\nstart, 90\n"
    deck = folder / f"{name.replace(' ', '_')}.inp"
    deck.write_text(text)
    return deck


def rotor_of(case):
    _, elements, disks, bearings, _, _ = case
    material = ross.Material("s", rho=RHO, E=E, Poisson=NU)
    shaft = [ross.ShaftElement(L=float(l), odl=float(o), idl=float(i), material=material) for l, o, i in elements]
    parts = [ross.DiskElement(n=n, m=m, Id=d, Ip=p) for n, m, d, p in disks]
    held = []
    for node, rest, end in bearings:
        names = ["kxx", "kxy", "kyx", "kyy", "cxx", "cxy", "cyx", "cyy"]
        if end is None:
            held.append(ross.BearingElement(n=node, **dict(zip(names, map(float, rest)))))
        else:
            values = {k: a + (b - a) * TABLE / TABLE[-1] for k, a, b in zip(names, rest, end)}
            held.append(ross.BearingElement(n=node, frequency=TABLE * math.pi / 30, **values))
    return ross.Rotor(shaft, parts, held)


def eigenvalues(rotor, speed):
    """Of the upper half plane, those whose vector moves across the axis; ascending by frequency."""
    value, vector = np.linalg.eig(rotor.A(speed))
    size = vector.shape[0] // 2
    shape = np.abs(vector[:size])
    lateral = sum(np.sum(shape[i::6] ** 2, axis=0) for i in (0, 1, 3, 4))
    along = sum(np.sum(shape[i::6] ** 2, axis=0) for i in (2, 5))
    return np.array(sorted(value[(value.imag > 1e-3) & (lateral > along)], key=lambda v: v.imag))


def compare(checks, folder, case):
    name, elements, _, _, unbalance, highest = case
    deck, rotor = deck_of(folder, case), rotor_of(case)
    out = subprocess.run([PROGRAM, "speeds", str(deck), "--speeds", f"0:{highest}:5", "--draws", "1", "--json", "-"], capture_output=True, text=True)
    if not checks.true(f"{name}: rotid speeds", out.returncode in (0, 1), out.stderr):
        return
    result = parse(out.stdout)
    worst_hz = worst_decrement = 0.0
    count, missed = 0, []
    for at in result["campbell"]:
        lam = eigenvalues(rotor, at["speed_rpm"] * math.pi / 30)
        own = np.array([complex(-m["log_decrement"] * m["frequency_hz"], 2 * math.pi * m["frequency_hz"]) for m in at["modes"]])
        for v in own:
            peer = lam[np.argmin(abs(lam - v))]
            worst_hz = max(worst_hz, abs(peer.imag - v.imag) / abs(peer.imag))
            worst_decrement = max(worst_decrement, abs(peer.real - v.real) / abs(peer))
            count += 1
        missed += [v for v in lam if v.imag < 0.99 * own.imag.max() and min(abs(own - v)) > 1e-4 * abs(v)]
    checks.true(f"{name}: {count} natural frequencies ({EXACT:g}, worst {worst_hz:.1e})", count >= 20 and worst_hz < EXACT, worst_hz)
    checks.true(f"{name}: their damping, of |lambda| ({EXACT:g}, worst {worst_decrement:.1e})", worst_decrement < EXACT, worst_decrement)
    checks.true(f"{name}: ROSS has no other mode there", not missed, missed)

    nodes = {"x": (unbalance, 0), "y": (0, 1)}
    worst_size = worst_phase = 0.0
    for probe in result["unbalance"]:
        pick = np.linspace(1, len(probe["speed_rpm"]) - 1, 15).astype(int)
        speed = np.array([probe["speed_rpm"][i] for i in pick]) * math.pi / 30
        forced = rotor.run_unbalance_response(node=[unbalance], unbalance_magnitude=[0.002], unbalance_phase=[math.radians(25)], frequency=speed)
        node, axis = nodes[probe["probe"]]
        peer = forced.forced_resp[6 * node + axis]
        own = np.array([probe["amplitude_m"][i] * np.exp(-1j * math.radians(probe["phase_deg"][i])) for i in pick])
        worst_size = max(worst_size, max(abs(abs(peer) - abs(own)) / abs(peer)))
        worst_phase = max(worst_phase, max(abs(np.angle(peer / own))))
    checks.true(f"{name}: amplitudes of the unbalance response ({EXACT:g}, worst {worst_size:.1e})", worst_size < EXACT, worst_size)
    checks.true(f"{name}: their phases [rad] ({EXACT:g}, worst {worst_phase:.1e})", worst_phase < EXACT, worst_phase)


def finer(case, parts):
    """Every element in so many equal parts, and nothing but the Campbell diagram asked for."""
    name, elements, disks, bearings, unbalance, highest = case
    return (name, [(l / parts, o, i) for l, o, i in elements for _ in range(parts)], [(parts * n, m, d, p) for n, m, d, p in disks],
            [(parts * n, rest, end) for n, rest, end in bearings], parts * unbalance, highest)


def times(checks, folder):
    """41 speeds in one run, processor time, 72 elements: the whole process of rotid without a response, and the call of ROSS alone."""
    case = finer(ROTORS[4], 3)
    deck, rotor = deck_of(folder, case), rotor_of(case)
    deck.write_text(deck.read_text().split("*UNBALANCE")[0])
    began = time.process_time()
    rotor.run_campbell(np.linspace(0, case[5] * math.pi / 30, 41), frequencies=8)
    peer, own = time.process_time() - began, math.inf
    for _ in range(3):
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([PROGRAM, "speeds", str(deck), "--speeds", f"0:{case[5]}:41", "--draws", "1", "--threads", "1", "--quiet"], capture_output=True)
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        own = min(own, ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime)
    print(f"Campbell diagram of 41 speeds: {peer / own:.0f} times faster ({FASTER} asked, by processor; {1000 * own:.0f} ms, ROSS {peer:.1f} s)")


def main():
    checks = Checks()
    with temporary_folder() as folder:
        for case in ROTORS:
            compare(checks, Path(folder), case)
        times(checks, Path(folder))
    checks.end()


main()

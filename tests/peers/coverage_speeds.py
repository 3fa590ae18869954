"""How often the bands of rotid speeds hold the truth: virtual machines drawn from the stated priors, whose test at rest and whose
critical speeds ROSS computes.

    python coverage_speeds.py PROGRAM [MACHINES [SEED]]

Truth: E and G of a core, evenly; stiffness of two bearings and magnetic pull, ln-normal by their STD. The hammer test gives five
frequencies of the free rotor with normal noise. Printed: the share of the 95 % bands that hold the true forward critical speed
(asked 93 to 97 %), chi2 of the ranks of the truth among the draws in ten bins, and the probabilities of kept margins in
five bins beside what happened. The last line begins with ok or FAILED: three deviations of the count, chi2 below its 0.1 % point. An interrupt or SIGTERM ends
the drawing, and what there is by then is judged."""
import math
import signal
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
from scipy import linalg, stats

warnings.simplefilter("ignore")
import ross

from support import Checks, parse, temporary_folder

SECTIONS = [(0.5, 0.12, 6), (0.9, 0.25, 12), (0.5, 0.12, 6)]  # length, diameter, elements; the second one is the core
STEEL, SHEETS = (2.1e11, 2.1e11 / 2.6, 7850.0), 7400.0
BEARINGS, NOISE, STD_K, STD_PULL, MARGIN = (3, 21), 0.002, 0.2, 0.3, 0.15  # nodes of the bearings; the rest relative
DRAWS, RANKS = 300, 100  # of a band, whose limits then scatter by a tenth of a standard deviation, and of a rank
PLANE = [0, 1, 3, 4]  # of the six degrees of freedom of a node: those across the axis


def matrices(e, g, stiffness=(), pull=0.0):
    """K, M and G across the axis."""
    core = ross.Material("core", rho=SHEETS, E=e, G_s=g)
    core.Poisson = 0.3  # of Cowper's coefficient alone, as the deck states it; ROSS would take E/2G - 1
    steel = ross.Material("steel", rho=STEEL[2], E=STEEL[0], G_s=STEEL[1])
    shaft = [ross.ShaftElement(L=l / n, odl=d, idl=0.0, material=core if s == 1 else steel) for s, (l, d, n) in enumerate(SECTIONS) for _ in range(n)]
    held = [ross.BearingElement(n=n, kxx=k, cxx=0.0) for n, k in zip(BEARINGS, stiffness)] or [ross.BearingElement(n=0, kxx=0.0, cxx=0.0)]
    rotor = ross.Rotor(shaft, [], held)
    pick = [6 * n + d for n in range(len(shaft) + 1) for d in PLANE]
    k, m, gyro = (np.array(a)[np.ix_(pick, pick)] for a in (rotor.K(0), rotor.M(0), rotor.G()))
    first, count = SECTIONS[0][2], SECTIONS[1][2]
    for i in range(count + 1):
        share = (0.5 if i in (0, count) else 1.0) / count
        for d in (0, 1):
            k[4 * (first + i) + d, 4 * (first + i) + d] -= pull * share
    return k, m, gyro


def free_hz(e, g):
    k, m, _ = matrices(e, g)
    x = [4 * i + d for i in range(len(k) // 4) for d in (0, 3)]
    return np.sqrt(linalg.eigh(k[np.ix_(x, x)], m[np.ix_(x, x)], eigvals_only=True)[2:7]) / (2 * math.pi)


def first_forward_rpm(*values):
    """K q = W^2 (M - i G) q: undamped, q e^{iWt} at the speed W; forward where Im(conj(x) y) < 0, x = cos, y = sin."""
    k, m, gyro = matrices(*values)
    value, vector = linalg.eig(k, m - 1j * gyro)
    found = []
    for v, q in zip(value, vector.T):
        x, y = q[0::4], q[1::4]
        if v.real > 1 and abs(v.imag) < 1e-6 * v.real and np.sum((np.conj(x) * y).imag) < 0:
            found.append(math.sqrt(v.real) * 30 / math.pi)
    return min(found)


def draw(rng):
    e, g = rng.uniform(1.2e11, 2.4e11), rng.uniform(3e10, 9e10)
    stated, pull = 10 ** rng.uniform(7.7, 9, 2), 10 ** rng.uniform(6, 7.2)
    truth = first_forward_rpm(e, g, stated * np.exp(STD_K * rng.standard_normal(2)), pull * math.exp(STD_PULL * rng.standard_normal()))
    low = first_forward_rpm(1.8e11, 6e10, stated, pull) * rng.uniform(1.0, 1.5)
    hz = free_hz(e, g) * (1 + NOISE * rng.standard_normal(5))
    z = np.concatenate([[0], np.cumsum([l / n for l, _, n in SECTIONS for _ in range(n)])])
    text = f"*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n{STEEL[0]!r}, {STEEL[1]!r}, 0.3\n*DENSITY\n{STEEL[2]!r}\n"
    text += f"*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n1.8e11, 6e10, 0.3\n*DENSITY\n{SHEETS!r}\n"
    for name, (l, d, n) in zip(("left", "core", "right"), SECTIONS):
        text += f"*SHAFT, NAME={name}, MATERIAL={'sheets' if name == 'core' else 'steel'}\n{l}, {d}, 0, {n}\n"
    text += "*MODES\n" + "".join(f"{i + 1}, {f!r}\n" for i, f in enumerate(map(float, hz))) + f"*NOISE, FREQUENCY={NOISE}\n"
    text += "*FIT, FUNCTIONAL=LIKELIHOOD\n*IDENTIFY\ncore.E, 3e10, 6e11, 1.8e11\ncore.G, 8e9, 3e11, 6e10\n*RUNNING\n"
    text += "".join(f"*BEARING, NAME=b{i}, STD={STD_K}\n{z[n]:.15g}, {float(k)!r}, 0\n" for i, (n, k) in enumerate(zip(BEARINGS, stated)))
    text += f"*PULL, GROUP=core, STD={STD_PULL}\n{float(pull)!r}\n"
    return text, float(truth), float(low)


def speeds(path, text, margin, low, high, draws, seed):
    """The first forward critical speed, by the program; None where that fails."""
    path.write_text(f"{text}*OPERATION, MARGIN={margin}\n{low!r}, {high!r}\n")
    out = subprocess.run([sys.argv[1], "speeds", str(path), "--speeds", "0:25000:3", "--draws", str(draws), "--threads", "1", "--seed", str(seed),
                          "--json", "-"], capture_output=True, text=True)
    found = [c for c in parse(out.stdout)["critical_speeds"] if c["whirl"] == "forward"] if out.returncode in (0, 1) else []
    return found[0] if found else None


def kept(truth, low):
    high = 1.02 * low
    return (low - truth) / low >= MARGIN or (truth - high) / high >= MARGIN


def main():
    machines, seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1000, int(sys.argv[3]) if len(sys.argv) > 3 else 1
    rng, checks = np.random.default_rng(seed), Checks()
    cases = []
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with temporary_folder() as folder:
        try:
            for number in range(machines):
                text, truth, low = draw(rng)
                path = Path(folder) / "machine.inp"
                found = speeds(path, text, MARGIN, low, 1.02 * low, DRAWS, number)
                # kept where a draw lies below the truth: its rank
                ranked = speeds(path, text, 1e-9, truth, 1e3 * truth, RANKS, machines + number)
                if not found or not ranked:
                    checks.true(f"machine {number}", False, text)
                    continue
                lower, upper = found["ci95"]
                cases.append((lower <= truth <= upper, ranked["margin"]["probability"] + rng.uniform(-0.5, 0.5) / RANKS, found["margin"]["probability"], kept(truth, low)))
        except KeyboardInterrupt:  # what there is by then is judged
            pass
    inside, ranks, margins = sum(c[0] for c in cases), [c[1] for c in cases], [c[2:] for c in cases]
    count = len(ranks)
    bins = np.histogram(np.clip(ranks, 0, 1), 10, (0, 1))[0]
    chi2 = float(np.sum((bins - count / 10) ** 2) / (count / 10))
    off = 3 * math.sqrt(0.95 * 0.05 * count) + 0.5
    checks.true(f"{inside} of {count} bands hold the truth ({100 * inside / count:.1f} %)", abs(inside - 0.95 * count) <= off, inside)
    checks.true(f"ranks {bins.tolist()}: chi2 {chi2:.1f}", chi2 < stats.chi2.ppf(0.999, 9), chi2)
    for b in range(5):
        of = [(p, k) for p, k in margins if p is not None and b / 5 <= p < (b + 1) / 5 + (b == 4)]
        if len(of) < 5:
            continue
        said, seen, std = sum(p for p, _ in of), sum(k for _, k in of), math.sqrt(sum(p * (1 - p) for p, _ in of))
        checks.true(f"margins of probability {b / 5:.1f} to {(b + 1) / 5:.1f}: {seen} of {len(of)} kept, {said:.1f} said", abs(seen - said) <= 3 * std + 0.5, seen)
    checks.end()


main()

"""rotid ema beside sdypy-EMA: on modes that are known and on a measured beam.

usage: ema_peer.py PROGRAM [BEAM.uff]
Needs sdypy and pyuff. Frequencies within 0.02 %, damping within 5 %, MAC of the shapes above 0.999 (known modes); on the measured
beam the same frequencies, and damping within 10 % of the first seven. The last two peaks are not those of one
pole: the peer's own damping there goes from 2.4e-4 to 3.6e-4 and from 0.8e-4 to 1.4e-4 with its order and band, and judges nothing.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyuff
from sdypy import EMA

FAILED = []


def check(name, ok, text):
    print(("ok      " if ok else "FAILED  ") + name + ": " + text)
    if not ok:
        FAILED.append(name)


def write(path, f, h):
    uff = pyuff.UFF(str(path))
    for c, row in enumerate(h):
        uff.write_sets(pyuff.prepare_58(
            binary=0, func_type=4, rsp_node=c + 1, rsp_dir=1, ref_node=1, ref_dir=1, data=row, x=f, id1=f"channel {c}",
            rsp_ent_name="NONE", ref_ent_name="NONE", abscissa_spacing=1, abscissa_spec_data_type=18,
            ordinate_spec_data_type=12, orddenom_spec_data_type=13), "overwrite" if c == 0 else "add")


def rotid(program, path):
    with tempfile.TemporaryDirectory() as folder:
        out = subprocess.run([program, "ema", str(path), "-o", folder + "/shapes.uff", "--json", "-"], check=True,
                             capture_output=True, text=True).stdout
    modes = json.loads(out)["modes"]
    return (np.array([m["frequency_hz"] for m in modes]), np.array([m["damping"] for m in modes]),
            np.array([[s["value"] for s in m["shape"]] for m in modes], dtype=float).T,
            np.array([m["damping_std"] for m in modes], dtype=float))


def peer(f, h, near, order):
    model = EMA.Model(h, f, lower=f[0], upper=f[-1], pol_order_high=order, frf_form="accelerance")
    model.get_poles(method="lscf", show_progress=False)
    model.select_closest_poles(list(near))
    model.get_constants(FRF_ind="all")
    return np.array(model.nat_freq), np.array(model.nat_xi), model.A


def mac(a, b):
    return abs(np.vdot(a, b)) ** 2 / (np.vdot(a, a).real * np.vdot(b, b).real)


def compare(name, mine, other, damping):
    for r in range(len(other[0])):
        k = int(np.argmin(abs(mine[0] - other[0][r])))
        check(f"{name} frequency {r}", abs(mine[0][k] / other[0][r] - 1) < 2e-4, f"{mine[0][k]:.5f} {other[0][r]:.5f} Hz")
        check(f"{name} damping {r}", abs(mine[1][k] / other[1][r] - 1) < damping, f"{mine[1][k]:.7f} {other[1][r]:.7f}")
        check(f"{name} shape {r}", mac(mine[2][:, k], other[2][:, r]) > 0.999, f"MAC {mac(mine[2][:, k], other[2][:, r]):.6f}")


def known():
    """A free-free bar by its asymptotic shapes, in closed form, with noise a thousandth of the rms."""
    f = np.arange(20, 620, 0.1)
    s = 2j * np.pi * f
    x = np.linspace(0, 1, 11)
    hz, zeta, phi = [], [], []
    for r in range(4):
        beta = (2 * r + 3) * np.pi / 2
        hz.append(60 * ((2 * r + 3) / 3) ** 2)
        zeta.append(2e-3 * (1 + r / 2))
        phi.append(np.cos(beta * x - np.pi / 4) / np.cos(np.pi / 4) + 0.4 * np.exp(-beta * x))
    phi = np.array(phi)
    h = sum(np.outer(phi[r] * phi[r][0], s ** 2 / ((2 * np.pi * hz[r]) ** 2 + s ** 2 + 4 * np.pi * zeta[r] * hz[r] * s))
            for r in range(4))
    rng = np.random.default_rng(1)
    scale = np.sqrt((abs(h) ** 2).mean(axis=1, keepdims=True) / 2) * 1e-3
    return f, h + scale * (rng.standard_normal(h.shape) + 1j * rng.standard_normal(h.shape)), (np.array(hz), np.array(zeta), phi.T)


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        f, h, truth = known()
        path = Path(folder) / "known.uff"
        write(path, f, h)
        mine = rotid(program, path)
        check("known count", len(mine[0]) == 4, f"{len(mine[0])} modes, 4 expected")
        compare("known, truth", mine, truth, 0.05)
        compare("known, peer", mine, peer(f, h, truth[0], 60), 0.05)
    if len(sys.argv) > 2:
        sets = [s for s in pyuff.UFF(sys.argv[2]).read_sets() if s["type"] == 58]
        f, h = sets[0]["x"], np.array([s["data"] for s in sets])
        mine = rotid(program, sys.argv[2])
        keep = (f >= 40) & (f <= 2200)
        other = peer(f[keep], h[:, keep], mine[0][mine[0] < 2100], 60)
        for r in range(len(other[0])):
            k = int(np.argmin(abs(mine[0] - other[0][r])))
            check(f"beam frequency {r}", abs(mine[0][k] / other[0][r] - 1) < 2e-4, f"{mine[0][k]:.5f} {other[0][r]:.5f} Hz")
            text = f"{mine[1][k]:.7f} +- {mine[3][k]:.7f} {other[1][r]:.7f}"
            if other[0][r] < 1500:
                check(f"beam damping {r}", abs(mine[1][k] / other[1][r] - 1) < 0.1, text)
            else:
                print(f"told    beam damping {r}: {text}")
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())

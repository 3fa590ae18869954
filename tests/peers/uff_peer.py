"""Universal files that pyuff wrote: rotid finds sensors, frequencies and shapes in them. Model and measured modes come from NumPy (the
elements of tools/bench/scipy_fit.py); frequencies and shapes are moved a little so that errors, MAC and NCO have something to show."""
import sys
from pathlib import Path

from support import ROOT, Checks, parse, result, rotid, temporary_folder

sys.path.insert(0, str(ROOT / "tools" / "bench"))
import numpy as np
import pyuff
import scipy_fit

LENGTH = 1.0
SECTIONS = ((0.3, 0.05, 12), (0.4, 0.10, 16), (0.3, 0.06, 12))
SPRING = 5000.0  # N/m at both ends
MODEL = """*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.3
*DENSITY
7850
*SHAFT, NAME=left, MATERIAL=steel
0.3, 0.05, 0, 12
*SHAFT, NAME=core, MATERIAL=steel
0.4, 0.10, 0, 16
*SHAFT, NAME=right, MATERIAL=steel
0.3, 0.06, 0, 12
*SPRING
start, 5000
end, 5000
"""
MODES = 4
SENSORS = np.arange(0, 41, 2)  # nodes of the model, every second one


def beam():
    """Modes of the full model and the mass condensed onto the sensors."""
    n = 2 * (sum(count for _, _, count in SECTIONS) + 1)
    k, m = np.zeros((n, n)), np.zeros((n, n))
    i = 0
    for length, d, count in SECTIONS:
        pair = scipy_fit.element(2.1e11, 2.1e11 / 2.6, scipy_fit.shear_coefficient(0.3), 7850.0, *scipy_fit.disc(d), length / count)
        for _ in range(count):
            place = slice(2 * i, 2 * i + 4)
            k[place, place] += pair[0]
            m[place, place] += pair[1]
            i += 1
    k[0, 0] += SPRING
    k[-2, -2] += SPRING
    lam, phi = scipy_fit.eigh(k, m)
    masters = 2 * SENSORS
    slaves = np.setdiff1d(np.arange(n), masters)
    psi = np.zeros((n, masters.size))
    psi[masters, np.arange(masters.size)] = 1
    psi[slaves] = -np.linalg.solve(k[np.ix_(slaves, slaves)], k[np.ix_(slaves, masters)])
    return np.sqrt(lam[2:]) / (2 * np.pi), phi[masters, 2:], psi.T @ m @ psi


HZ, SHAPES, MASS = beam()
Z = SENSORS * LENGTH / 40
RANDOM = np.random.default_rng(7)
MEASURED_HZ = HZ[:MODES] * np.array([1.01, 0.98, 1.005, 0.99])
MEASURED = SHAPES[:, :MODES] / abs(SHAPES[:, :MODES]).max(axis=0) + 0.05 * RANDOM.standard_normal((Z.size, MODES))
IDS = 100 + 3 * np.arange(Z.size)


def correlation(a, b, mass=None):
    mass = np.eye(a.size) if mass is None else mass
    return (a @ mass @ b) ** 2 / ((a @ mass @ a) * (b @ mass @ b))


def write(path, *sets):
    Path(path).unlink(missing_ok=True)
    pyuff.UFF(str(path)).write_sets(list(sets), mode="overwrite")


def nodes(number, x, y, z, ids=IDS):
    zero = np.zeros(ids.size, int)
    return {"type": number, "node_nums": ids, "def_cs": zero, "disp_cs": zero, "color": zero + 8, "x": x, "y": y, "z": z}


def shape(analysis, mode, components, **more):
    order = RANDOM.permutation(IDS.size)  # nodes come in any order
    r = [np.asarray(c)[order] for c in components]
    return {"type": 55, "model_type": 1, "analysis_type": analysis, "data_ch": 2, "spec_data_type": 8, "load_case": 1, "mode_n": mode,
            "node_nums": IDS[order], "r1": r[0], "r2": r[1], "r3": r[2], **more}


def check(checks, name, deck, hz, measured, partners, conjugates=False):
    """partners: mode of the model, from 1, of each measured one."""
    seen = result("check", deck)
    checks.true(f"{name}: sensors", [s["id"] for s in sorted(seen["sensors"], key=lambda s: s["z_m"])] == list(IDS), seen["sensors"])
    checks.close(f"{name}: positions", sorted(s["z_m"] for s in seen["sensors"]), Z, 0, 5e-6 * LENGTH)
    report = result("modes", deck)
    checks.close(f"{name}: positions of the shapes", report["sensor_z_m"], Z, 0, 5e-6 * LENGTH)
    paired = {m["mode"]: m for m in report["modes"] if "measured_hz" in m}
    if not checks.true(f"{name}: partners", sorted(paired) == sorted(partners), sorted(paired)):
        return
    found = [paired[p] for p in partners]
    checks.true(f"{name}: paired by shape", all(m["paired_by"] == "shape" for m in found), [m["paired_by"] for m in found])
    checks.close(f"{name}: measured frequencies", [m["measured_hz"] for m in found], hz, 1e-5)
    checks.close(f"{name}: frequencies of the model", [m["predicted_hz"] for m in found], HZ[np.array(partners) - 1], 1e-6)
    checks.close(f"{name}: errors", [m["error_percent"] for m in found], 100 * (HZ[np.array(partners) - 1] / hz - 1), 0, 2e-3)
    model = SHAPES[:, np.array(partners) - 1].T
    checks.close(f"{name}: MAC", [m["mac"] for m in found], [correlation(a, b) for a, b in zip(measured.T, model)], 0, 2e-5)
    checks.close(f"{name}: NCO", [m["nco"] for m in found], [correlation(a, b, MASS) for a, b in zip(measured.T, model)], 0, 2e-5)
    checks.true(f"{name}: {'says' if conjugates else 'says nothing'} that shapes are left out",
                any("left out" in w for w in report["warnings"]) == conjugates, report["warnings"])


def main():
    checks = Checks()
    zero = np.zeros(Z.size)
    eigen = 2 * np.pi * MEASURED_HZ * (-0.01 + 1j * np.sqrt(1 - 0.01**2))
    with temporary_folder() as folder:
        uff, deck = Path(folder) / "modes.uff", Path(folder) / "deck.inp"

        write(uff, nodes(15, zero, zero, Z),
              *(shape(2, k + 1, (MEASURED[:, k], zero, zero), freq=MEASURED_HZ[k], modal_damp_vis=0.01) for k in range(MODES)))
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff\n")
        check(checks, "15 + 55 real", deck, MEASURED_HZ, MEASURED, [1, 2, 3, 4])
        code, out, _ = rotid("modes", deck, "--json", "-")
        checks.true("a deck names its file relative to itself", code == 0 and len(parse(out)["modes"]) >= MODES, code)

        # each mode turned by a phase of its own, and its conjugate beside it
        turned = MEASURED * np.exp(1j * np.array([0.3, 1.2, -2.0, 3.0]))
        for analysis in (3, 7):
            pairs = []
            for k in range(MODES):
                for conjugate in (0, 1):
                    v, s = (turned[:, k].conj(), eigen[k].conj()) if conjugate else (turned[:, k], eigen[k])
                    pairs.append(shape(analysis, 2 * k + conjugate + 1, (v, 0 * v, 0 * v), eig=s))
            write(uff, nodes(15, zero, zero, Z), *pairs)
            check(checks, f"15 + 55 complex, analysis type {analysis}", deck, MEASURED_HZ, MEASURED, [1, 2, 3, 4], conjugates=True)

        # other axis, other direction, other unit, counted from the other end and from a flange 250 mm beyond it
        write(uff, nodes(2411, 1000 * (LENGTH - Z) + 250, zero, zero),
              *(shape(2, k + 1, (zero, MEASURED[:, k], 9 * MEASURED[:, 0]), freq=MEASURED_HZ[k]) for k in range(MODES)))
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff, AXIS=X, DIRECTION=Y, SCALE=0.001, FLIP=YES, ORIGIN=1.25\n")
        check(checks, "2411 + 55 real, axis, direction, scale, flip, origin", deck, MEASURED_HZ, MEASURED, [1, 2, 3, 4])
        write(uff, nodes(2411, zero, LENGTH - Z, zero),
              *(shape(3, k + 1, (0 * turned[:, k], 0 * turned[:, k], turned[:, k]), eig=eigen[k]) for k in range(MODES)))
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff, AXIS=Y, DIRECTION=Z, FLIP=YES\n")
        check(checks, "2411 + 55 complex, flipped about the middle", deck, MEASURED_HZ, MEASURED, [1, 2, 3, 4])

        # numbered 1 2 3, but one mode of the model was missed: the shapes say which
        kept = [0, 2, 3]
        write(uff, nodes(2411, zero, zero, Z),
              *(shape(2, n + 1, (MEASURED[:, k], zero, zero), freq=MEASURED_HZ[k]) for n, k in enumerate(kept)))
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff\n")
        check(checks, "2411 + 55, a mode missing", deck, MEASURED_HZ[kept], MEASURED[:, kept], [1, 3, 4])
        warnings = result("modes", deck)["warnings"]
        checks.true("a mode that was not measured is named", any("mode 2 of the model" in w for w in warnings), warnings)

        # nodes of the geometry that carry no shape are no sensors; frequency responses are no modes
        extra = np.r_[IDS, 900, 901]
        write(uff, nodes(15, np.r_[zero, 5, 5], np.r_[zero, 0, 0], np.r_[Z, -3, 7], ids=extra),
              *(shape(2, k + 1, (MEASURED[:, k], zero, zero), freq=MEASURED_HZ[k]) for k in range(MODES)),
              shape(5, 1, (MEASURED[:, 0], zero, zero), freq=333.0, freq_step_n=1))
        check(checks, "15 + 55, nodes and sets of something else", deck, MEASURED_HZ, MEASURED, [1, 2, 3, 4])

        # positions from the deck, shapes from a file without nodes
        sensors = "*SENSORS\n" + "".join(f"{i}, {z:.9g}\n" for i, z in zip(IDS, Z))
        write(uff, *(shape(2, k + 1, (MEASURED[:, k], zero, zero), freq=MEASURED_HZ[k]) for k in range(MODES)))
        deck.write_text(MODEL + sensors + "*MEASURED, FILE=modes.uff\n")
        check(checks, "55 real, sensors from the deck", deck, MEASURED_HZ, MEASURED, [1, 2, 3, 4])
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff\n")
        code, out, err = rotid("check", deck)
        checks.true("55 without nodes or sensors is refused", code == 2 and "no nodes" in err and not out, (code, err[:200]))
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff, DIRECTION=Y\n" + sensors)
        code, out, err = rotid("check", deck)
        checks.true("a direction without motion is refused", code == 2 and "DIRECTION" in err and not out, (code, err[:200]))

        # mode 1 with some of mode 3 a quarter of a period late
        late = MEASURED[:, 0] + 0.4j * MEASURED[:, 2]
        phases = np.exp(1j * np.linspace(0, np.pi, 20001))
        share = min(((late * p).imag ** 2).sum() for p in phases) / (abs(late) ** 2).sum()
        write(uff, nodes(15, zero, zero, Z), shape(3, 1, (late, 0 * late, 0 * late), eig=eigen[0]))
        deck.write_text(MODEL + "*MEASURED, FILE=modes.uff\n")
        warnings = result("modes", deck)["warnings"]
        named = any(w.startswith(f"{100 * share:.0f} % of the motion") and "out of phase" in w for w in warnings)
        checks.true(f"motion out of phase is named: {100 * share:.0f} %", share > 0.05 and named, warnings)

        write(uff, nodes(15, zero, zero, 1000 * Z),
              *(shape(2, k + 1, (MEASURED[:, k], zero, zero), freq=MEASURED_HZ[k]) for k in range(MODES)))
        code, out, err = rotid("check", deck)
        checks.true("millimetres without SCALE are refused", code == 2 and "outside the rotor" in err and not out, (code, err[:200]))
    checks.end()


if __name__ == "__main__":
    main()

"""The files of tools/hammer in pyuff and NumPy: channels, nodes, units, and the frequency response that the truth says. Called with the
program hammer in place of rotid: python tests/peers/hammer_peer.py BUILD/hammer."""
import json
import subprocess
import sys
from pathlib import Path

from support import Checks, parse, temporary_folder

import numpy as np
import pyuff

FORCE, ACCELERATION = 13, 12


def hammer(folder, name, *options):
    """Sets of the file by type, the truth, the deck."""
    paths = [Path(folder) / f"{name}.{end}" for end in ("unv", "json", "inp")]
    subprocess.run([sys.argv[1], *options, "-o", paths[0], "--truth", paths[1], "--deck", paths[2]], check=True, timeout=120)
    return pyuff.UFF(str(paths[0])).read_sets(), parse(paths[1].read_text()), paths[2].read_text()


def accelerance(truth, hammer_point, sensor_point, hz):
    """Modes of the truth alone, so without what lies above them."""
    s, total = 2j * np.pi * hz, 0
    for mode in truth["modes"]:
        w = 2 * np.pi * mode["hz"]
        shape = mode["shape"]
        total = total + shape[hammer_point] * shape[sensor_point] / mode["mass"] / (s * s + 2 * mode["damping"] * w * s + w * w)
    return s * s * total


def pairs(sets):
    functions = [s for s in sets if s["type"] == 58]
    return list(zip(functions[0::2], functions[1::2]))


def layout(checks, name, sets, truth, roving):
    nodes = next(s for s in sets if s["type"] == 2411)
    checks.true(f"{name}: order of the sets", [s["type"] for s in sets[:4]] == [151, 164, 2411, 58])
    checks.true(f"{name}: SI", next(s for s in sets if s["type"] == 164)["length"] == 1)
    checks.close(f"{name}: nodes along z", nodes["z"], [p["z"] for p in truth["points"]], 1e-12, 1e-12)
    measurements = pairs(sets)
    ids = [p["id"] for p in truth["points"]]
    expected = [(m["point"], truth["fixed"]) if roving == "sensor" else (truth["fixed"], m["point"]) for m in truth["measurements"]]
    checks.true(f"{name}: measurements", len(measurements) == len(ids) * truth["impacts"] == len(expected))
    checks.true(f"{name}: nodes of the channels", [(a["rsp_node"], a["ref_node"]) for _, a in measurements] == expected)
    checks.true(f"{name}: force at the hammer", all(f["rsp_node"] == f["ref_node"] == a["ref_node"] for f, a in measurements))
    checks.true(f"{name}: quantities", all((f["ordinate_spec_data_type"], a["ordinate_spec_data_type"]) == (FORCE, ACCELERATION)
                                           for f, a in measurements))
    checks.true(f"{name}: load cases", [f["load_case_id"] for f, _ in measurements] == [a["load_case_id"] for _, a in measurements]
                == [m["load_case"] for m in truth["measurements"]])
    checks.true(f"{name}: time responses of equal length", all(x["func_type"] == 1 and len(x["data"]) == truth["samples"]
                                                               for pair in measurements for x in pair))
    checks.close(f"{name}: spacing", [1 / a["abscissa_inc"] for _, a in measurements], [truth["rate_hz"]] * len(measurements), 1e-6)


def response(checks, name, sets, truth, roving, tolerance):
    ids = [p["id"] for p in truth["points"]]
    worst = 0
    for force, acceleration in pairs(sets)[:: 3 * truth["impacts"] + 1]:
        hz = np.fft.rfftfreq(len(force["data"]), 1 / truth["rate_hz"])
        band = (hz > 100) & (hz < truth["band_hz"])
        h = np.fft.rfft(acceleration["data"])[band] / np.fft.rfft(force["data"])[band]
        expected = accelerance(truth, ids.index(force["rsp_node"]), ids.index(acceleration["rsp_node"]), hz[band])
        expected = expected + np.polyval(np.polyfit(hz[band], (h - expected).real, 4), hz[band])  # rigid modes, those above
        worst = max(worst, np.max(np.abs(h - expected)) / np.max(np.abs(expected)))
    checks.true(f"{name}: response over force ({tolerance:g})", worst < tolerance, worst)


def main():
    checks = Checks()
    with temporary_folder() as folder:
        for rotor, roving in (("paper", "sensor"), ("beam", "hammer")):
            sets, truth, deck = hammer(folder, rotor, rotor, "--roving", roving, "--modes-file", "made.unv")
            layout(checks, rotor, sets, truth, roving)
            response(checks, rotor, sets, truth, roving, 2e-3)
            checks.true(f"{rotor}: deck", "*MEASURED, FILE=made.unv" in deck and "FUNCTIONAL=LIKELIHOOD" in deck)
        text, _, _ = hammer(folder, "text", "beam", "--roving", "hammer", "--ascii", "--seconds", "0.25")
        binary, _, _ = hammer(folder, "binary", "beam", "--roving", "hammer", "--seconds", "0.25")
        worst = max(np.max(np.abs(t["data"] - b["data"])) / np.max(np.abs(b["data"]))
                    for pt, pb in zip(pairs(text), pairs(binary)) for t, b in zip(pt, pb))
        checks.true("text as binary, to six digits", worst < 1e-5, worst)
        again, _, _ = hammer(folder, "again", "beam", "--roving", "hammer", "--seconds", "0.25")
        same = (Path(folder) / "again.unv").read_bytes() == (Path(folder) / "binary.unv").read_bytes()
        checks.true("the same seed gives the same file", same and len(again) == len(binary))
        wrong = subprocess.run([sys.argv[1], "paper", "-o", Path(folder) / "x", "--rate", "0"], capture_output=True, text=True)
        checks.true("wrong option: exit code 2 and no file", wrong.returncode == 2 and "expected 100" in wrong.stderr
                    and not (Path(folder) / "x").exists(), json.dumps(wrong.stderr))
    checks.end()


if __name__ == "__main__":
    main()

"""Other programs for single steps of rotid's work, in one run and on the same data: sdypy-EMA (build/venv) and rotid ema on the same
transfer functions, ROSS's run_modal (build/venv-export) and one evaluation of rotid for the same rotor, CalculiX on bricks and rotid
modes for the same solid. Processor seconds, the best of a few; what is not installed is named as missing. Arguments: program, build
folder."""
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
rotid, build = sys.argv[1], pathlib.Path(sys.argv[2])
ROWS = []

# the records of ema_peer: a free-free bar in closed form, 11 points, four modes, noise a thousandth of the rms
EMA = """
import json, sys, time, pathlib
sys.path.insert(0, "tests/peers")
import numpy as np
import ema_peer
f, h, truth = ema_peer.known()
ema_peer.write(pathlib.Path(sys.argv[1]), f, h)
best = 1e9
for _ in range(1):
    begin = time.process_time()
    found = ema_peer.peer(f, h, truth[0], 60)
    best = min(best, time.process_time() - begin)
print(json.dumps({"seconds": best, "hz": list(map(float, found[0]))}))
"""
ROSS = """
import json, sys, time, warnings
warnings.simplefilter("ignore")
sys.path.insert(0, "tools/python")
from rotid import to_ross
best = 1e9
for _ in range(3):
    rotor = to_ross("input/paper_rotor.inp", start=True, program=sys.argv[1]) # ROSS keeps what it has computed
    begin = time.process_time()
    rotor.run_modal(0, num_modes=32, sparse=True)
    best = min(best, time.process_time() - begin)
print(json.dumps({"seconds": best}))
"""


def user_seconds(arguments, repeat=3):
    best = float("inf")
    for _ in range(repeat):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(arguments, capture_output=True, text=True, cwd=ROOT)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode not in (0, 1):
            raise RuntimeError(done.stderr[-300:])
        best = min(best, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    return best


def by(python, script, *arguments):
    """The last line that a script prints, as JSON; None where the interpreter or a module is missing."""
    if not pathlib.Path(python).exists():
        return None
    done = subprocess.run([python, "-W", "ignore", "-c", script, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)
    return json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else None


def extraction(folder):
    path = folder / "known.uff"
    peer = by(build / "venv/bin/python", EMA, path)
    if not peer:
        return "sdypy-EMA: missing (make check-peers installs it into build/venv)"
    own = user_seconds([rotid, "ema", str(path), "--threads", "1", "--quiet", "-o", str(folder / "shapes.uff"), "--order", "60"])
    ROWS.append(("extraction of modes, 11 functions of 6,000 lines, order 60", "sdypy-EMA, poles picked by hand", peer["seconds"],
                 "rotid ema, whole process", own))
    return None


def modal():
    peer = by(build / "venv-export/bin/python", ROSS, rotid)
    if not peer:
        return "ROSS: missing (make check-peers installs it into build/venv-export)"
    result = min((json.loads(subprocess.run([rotid, "identify", "input/paper_rotor.inp", "--no-baseline", "--quiet", "--json", "-", "--set",
                                             "FIT.REDUCTION=NONE"], cwd=ROOT, capture_output=True, text=True).stdout) for _ in range(5)),
                 key=lambda r: r["seconds"])
    ROWS.append(("modes of the paper's rotor, 352 unknowns", "ROSS run_modal", peer["seconds"],
                 "rotid, an evaluation of a fit with its share of derivatives", result["seconds"] / result["evaluations"]))
    return None


def solid():
    sys.path.insert(0, str(ROOT / "tools/solid3d"))
    sys.dont_write_bytecode = True
    import ccx
    if not ccx.PROGRAM:
        return "CalculiX: missing (Debian: calculix-ccx)"
    import check
    import deck
    import solid3d
    path = "tools/solid3d/two_step.inp"
    finest = check.Finest()
    limits, _ = solid3d.solve(deck.read(path), len(check.CONVERGED[path]), tell=finest)
    off = max(abs(100 * (a / b - 1)) for a, b in zip(finest.frequencies, limits))
    ROWS.append((f"solid with two steps, {finest.nodes} nodes of bricks, {off:.2f} % off", "CalculiX, the finest bricks", finest.seconds,
                 "rotid modes, whole process", user_seconds([rotid, "modes", path, "--quiet"])))
    return None


def main():
    os.chdir(ROOT)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with tempfile.TemporaryDirectory() as folder:
        steps = (("sdypy-EMA", lambda: extraction(pathlib.Path(folder))), ("ROSS", modal), ("CalculiX", solid))
        for name, step in steps:
            try:
                missing = step()
            except Exception as error: # a peer that fails is no failure of rotid, and is said
                missing = f"{name}: failed: {error}"
            if missing:
                print(missing, flush=True)
    print(f"\n{'processor seconds':60}{'peer':>34}{'[s]':>10}{'':3}{'rotid [s]':>10}{'ratio':>9}")
    for what, peer, seconds, how, own in ROWS:
        print(f"{what:60}{peer:>34}{seconds:10.4f}{'':3}{own:10.4f}{seconds / max(own, 1e-9):9.1f}   {how}")


main()

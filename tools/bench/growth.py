"""How the work of an identification grows: instructions by callgrind, libraries included, of one evaluation of a fit with its
Jacobian (medians over the calls, most of which begin with the modes of the step before), for three sizes that span a factor of eight,
and the exponent p of a + b n^p through them: what does not grow has no part in it. Replicates are those of a diagnosis, whole. Arguments:
program, folder."""
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys

rotid, folder = sys.argv[1], pathlib.Path(sys.argv[2]) / "growth"
folder.mkdir(exist_ok=True)
MOST = {"modes": 2.0} # asked; 1.1 of all others

HEAD = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"


def shaft(groups, elements):
    """A stepped steel shaft of 2 m, free, each group with a modulus of its own."""
    text = HEAD
    for i in range(groups):
        text += f"*MATERIAL, NAME=m{i}\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=g{i}, MATERIAL=m{i}\n"
        text += f"{2 / groups}, {0.05 + 0.01 * (i % 3)}, 0, {elements // groups}\n"
    return text


def run(*arguments):
    out = folder / "out.json"
    done = subprocess.run([rotid, *map(str, arguments), "--quiet", "--json", str(out)], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{arguments}: {done.stderr[-300:]}")
    return json.loads(out.read_text())


def callgrind(options, *arguments):
    for old in folder.glob("callgrind*"):
        old.unlink()
    done = subprocess.run(["valgrind", "--tool=callgrind", *options, f"--callgrind-out-file={folder}/callgrind", rotid,
                           *map(str, arguments), "--quiet", "--json", str(folder / "counted.json")], capture_output=True, text=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


def deck(name, elements=400, sensors=0, modes=6, parameters=1, states=1, shapes=False):
    """Data of the model itself, the frequencies off by up to 0.1 %."""
    path = folder / f"{name}.inp"
    groups = max(parameters, 2)
    text = shaft(groups, elements)
    if sensors:
        text += "*SENSORS\n" + "".join(f"{i + 1}, {2 * i / (sensors - 1):.9f}\n" for i in range(sensors))
    # as many modes are computed as are named
    path.write_text(text + "*MODES\n" + "".join(f"{k + 1}, {100.0 * (k + 1) ** 2}\n" for k in range(modes)))
    found = run("modes", path)["modes"][:modes]
    text += "*IDENTIFY\n" + "".join(f"g{i}.E, 1e11, 3e11, 1.9e11\n" for i in range(parameters))
    text += "*FIT, FUNCTIONAL=LIKELIHOOD, REDUCTION=NONE\n*NOISE, FREQUENCY=0.001, SHAPE=0.01\n"
    for s in range(states):
        if states > 1:
            text += f"*STATE, NAME=s{s}\n"
        text += "*MODES\n" + "".join(f"{k + 1}, {m['full_hz'] * (1 + 1e-3 * math.sin(7 * k + s))}\n" for k, m in enumerate(found))
        for k, m in enumerate(found if shapes else ()):
            text += f"*SHAPE, MODE={k + 1}\n" + "".join(f"{i + 1}, {v:.9g}\n" for i, v in enumerate(m["shape"]))
    path.write_text(text)
    return path


def median_of_calls(function, path):
    """Each call ends with a dump of its own."""
    callgrind([f"--toggle-collect={function}", f"--dump-after={function}"], "identify", path, "--no-baseline")
    return statistics.median(int(re.search(r"^totals: (\d+)", dump.read_text(), re.M).group(1)) for dump in folder.glob("callgrind.*"))


def per_evaluation(path):
    return median_of_calls("joint_residual", path) + median_of_calls("joint_jacobian", path)


SIZES = {
    "elements": (lambda n: deck("elements", elements=n), 400, 3200),
    "sensors": (lambda n: deck("sensors", elements=400, sensors=n, shapes=True), 25, 200),
    "modes": (lambda n: deck("modes", elements=1000, modes=n), 3, 24),
    "parameters": (lambda n: deck("parameters", elements=960, modes=16, parameters=n), 2, 16),
    "states": (lambda n: deck("states", elements=400, states=n), 2, 16),
}


def main():
    failed = 0
    print("instructions of an evaluation of a fit and its Jacobian")
    print(f"{'growth of an evaluation in':30}{'from':>8}{'to':>8}{'M instructions':>20}{'exponent':>18}")
    for name, (make, low, high) in SIZES.items():
        try:
            middle = round(math.sqrt(low * high))
            work = [per_evaluation(make(n)) for n in (low, middle, high)]
        except (RuntimeError, KeyError, statistics.StatisticsError) as error:
            print(f"{name}: not measured: {error}")
            failed += 1
            continue
        # of n^p: the increments are as high^p - middle^p to middle^p - low^p, which is (high/middle)^p where the sizes are in proportion
        if not work[0] < work[1] < work[2]:
            print(f"{name}: not measured: they do not rise: {work}")
            continue
        exponent = math.log((work[2] - work[1]) / (work[1] - work[0])) / math.log(math.sqrt(high / low))
        over = exponent > MOST.get(name, 1.1)
        print(f"{name:30}{low:8d}{high:8d}{work[0] / 1e6:10.2f}{work[2] / 1e6:10.2f}{exponent:10.2f}{'  above what is asked' if over else ''}",
              flush=True)
    return failed > 0


sys.exit(main())

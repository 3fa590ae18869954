"""Every command on every deck of input/, and on decks that bring out nulls and flags: the JSON follows docs/schema, and every number is
finite. Decks without *IDENTIFY end identify and sensitivity with exit code 2 and no output. ema runs on a measured beam."""
import json
import math
import re
from pathlib import Path

import jsonschema

from support import INPUT, ROOT, Checks, numbers, parse, rotid, temporary_folder

COMMANDS = ("check", "modes", "sensitivity", "identify", "diagnose")

# every card that a picture of the model draws, and a cause of every kind of target
MEMBERS = """*HEADING
members beside the axis
paper predicted_hz = 350, 640
*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.3
*DENSITY
7850
*BEAM, NAME=left, MATERIAL=steel
0.3, 0.06, 0.05, 6
*SHAFT, NAME=core, MATERIAL=steel
0.4, 0.1, 0.02, 8, 0.09
*SHAFT, NAME=right, MATERIAL=steel
0.3, 0.05, 0, 6
*PERFORATION, GROUP=core
6, 0.01, 0.03
*PRELOAD, GROUP=core
1e3
*TIEROD, NAME=rods, MATERIAL=steel, FROM=core.start, TO=core.end
6, 0.008, 0.035, 1e3, 3
*TIEROD, NAME=tube, MATERIAL=steel, FROM=0.1, TO=0.8, MODEL=TUBE
6, 0.008, 0.035, 1e3
*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.1
12, 0.006, 0.045, 4
*DISK, NAME=fan
0.9, 0.5, 1e-3, 2e-3
*DISK
0.1, 0.2
*SPRING
0.2, 1e4
*SLING, LENGTH=0.5
*SENSORS
1, start
2, 0.25
5, 0.6
9, end
*CAUSE, NAME=crack, TYPE=stiffness_local
depth, 0.2
z, 0.45
width, 0.05
*CAUSE, NAME=gap, TYPE=joint, BETWEEN=left,core
flexibility, 1e-9
*CAUSE, NAME=box, TYPE=accelerometer_mass, SENSOR=5, MOUNT=FIXED
mass, 0.02
"""
SHAFT = """*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.3
*DENSITY
7850
*SHAFT, NAME=left, MATERIAL=steel
0.3, 0.05, 0, 6
*SHAFT, NAME=core, MATERIAL=steel
0.4, 0.1, 0.02, 8
*SHAFT, NAME=right, MATERIAL=steel
0.3, 0.05, 0, 6
"""
MODES = """*MODES
1, 383
2, 640
3, 1690
"""
LONGEST = "paper_rotor_solid.inp"  # minutes of diagnosis, with the keys of that of solid_rotor.inp
# name: deck, options, exit codes of check, modes, sensitivity, identify, diagnose
SMALL = {
    "nothing measured": (SHAFT, (), (0, 0, 2, 2, 2)),
    "identified without data": (SHAFT + "*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n", (), (0, 0, 0, 2, 2)),
    "one parameter, no noise": (SHAFT + MODES + "*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n", (), (0, 0, 0, 0, 0)),
    "at a bound": (SHAFT + MODES + "*IDENTIFY\ncore.E, 2.5e11, 1e12, 3e11\n", (), (0, 0, 0, 1, 0)),
    "no degree of freedom left": (SHAFT + MODES + "*FIT, FUNCTIONAL=HYBRID, MODES=1\n*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n", (), (0, 0, 0, 0, 2)),
    "not determined": (SHAFT + MODES + "*IDENTIFY\ncore.G, 1e9, 1e13, 8e10\ncore.nu, 0, 0.5, 0.3\nleft.nu, 0, 0.5, 0.3\n", (), (0, 0, 0, 1, 2)),
    "condensed, noise stated, mode held out": (
        SHAFT + MODES + "*NOISE, FREQUENCY=0.01\n*FIT, FUNCTIONAL=HYBRID, REDUCTION=IRS, HOLDOUT=2\n*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n",
        (), (0, 0, 0, 0, 0)),
    "few sensors": (
        SHAFT + "*SENSORS\n1, start\n2, 0.5\n3, end\n" + MODES +
        "*SHAPE, MODE=1\n1, 1\n2, -0.6\n3, 1\n*SHAPE, MODE=2\n1, 1\n3, -1\n*NOISE, FREQUENCY=0.01, SHAPE=0.05\n*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n",
        (), (0, 0, 0, 0, 0)),
    "members beside the axis": (
        MEMBERS + "*MODES\n1, 240\n2, 385\n3, 650\n*NOISE, FREQUENCY=0.01\n*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n",
        (), (0, 0, 0, 0, 0)),
    "one sensor": (SHAFT + "*SENSORS\n1, start\n" + MODES + "*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n", (), (0, 0, 0, 0, 0)),
    "without the baseline": (SHAFT + MODES + "*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n", ("--no-baseline",), (0, 0, 0, 0, 0)),
}


def validate(checks, name, schema, text):
    try:
        value = parse(text)
    except ValueError as error:
        checks.true(name, False, error)
        return None
    errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in schema.iter_errors(value)]
    errors += [f"{n} is not finite" for n in numbers(value) if not math.isfinite(n)]
    checks.true(name, not errors, "; ".join(errors[:3]))
    return value


def main():
    checks = Checks()
    schemas = {}
    for command in (*COMMANDS, "frf", "ema", "export", "study", "study_line"):
        schema = json.loads((ROOT / "docs" / "schema" / f"{command}.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        schemas[command] = jsonschema.Draft202012Validator(schema)
        loose = [k for k, v in walk(schema) if v.get("type") == "object" and "additionalProperties" not in v]
        checks.true(f"schema of {command}: every object says what it may hold", not loose, loose)

    stops = set(re.findall(r'X\(ROTID_STOP_\w+, \d+, "([^"]+)"\)', (ROOT / "include" / "rotid.h").read_text()))
    reasons = set()
    for deck in sorted(INPUT.glob("*.inp")):
        cards = {line.split(",")[0].strip().upper() for line in deck.read_text().splitlines() if line.startswith("*")}
        identifies, is_measured = "*IDENTIFY" in cards, bool(cards & {"*MODES", "*MEASURED"})
        for command in COMMANDS:
            if command == "diagnose" and deck.name == LONGEST:
                continue
            needs = command in ("sensitivity", "identify") and not identifies or command in ("identify", "diagnose") and not is_measured
            run(checks, f"{command} {deck.name}", schemas[command], command, deck, (), (2,) if needs else (0, 1) if command == "identify" else (0,))

    with temporary_folder() as folder:
        synthesise(checks, schemas["frf"], Path(folder))
        export(checks, schemas["export"], Path(folder))
        extract(checks, schemas["ema"], Path(folder))
        study(checks, schemas["study"], schemas["study_line"], Path(folder))
        for name, (text, options, codes) in SMALL.items():
            deck = Path(folder) / "deck.inp"
            deck.write_text(text)
            for command, code in zip(COMMANDS, codes):
                out = run(checks, f"{command}, {name}", schemas[command], command, deck, options if command == "identify" else (),
                          (code, 1) if command == "identify" else (code,))
                reasons |= {out["stop_reason"]} if out and command == "identify" else set()
        checks.true("stop_reason is the text of a status", reasons and reasons <= stops, reasons - stops)
        written = Path(folder) / "result.json"
        code, out, _ = rotid("modes", INPUT / "solid_steel.inp", "--json", written, "--quiet")
        validate(checks, "modes --json FILE", schemas["modes"], written.read_text())
        checks.true("modes --json FILE --quiet prints nothing", code == 0 and not out, out[:80])
        left = sorted(p.name for p in Path(folder).iterdir())
        checks.true("no temporary file is left beside it", left == ["deck.inp", "result.json"], left)
    checks.end()


def run(checks, name, schema, command, deck, options, codes):
    """The result, or None where the program is to refuse."""
    code, out, err = rotid(command, deck, "--json", "-", *options)
    if code not in codes:
        checks.true(name, False, f"exit code {code} for {codes}: {err.strip()[:200]}")
    elif code == 2:
        checks.true(f"{name} is refused", not out and err, f"{out[:80]!r} {err[:80]!r}")
    else:
        value = validate(checks, name, schema, out)
        if value and "geometry" in value:
            draw(checks, name, value)
        return value
    return None


def draw(checks, name, result):
    """What the pictures rest on: a geometry without gaps, and shapes that give the printed MAC."""
    geometry, length = result["geometry"], result["geometry"]["length_m"]
    spans = [(s["from_m"], s["to_m"]) for g in geometry["groups"] if not g.get("layer_of") for s in g["segments"]]
    edges = [0] + [b for _, b in spans]
    joined = all(abs(a - e) < 1e-8 * length for (a, _), e in zip(spans, edges)) and abs(edges[-1] - length) < 1e-8 * length
    nodes = geometry["nodes_z_m"]
    inside = all(-1e-8 <= z <= length * (1 + 1e-8) for z in nodes + [s["z_m"] for s in geometry["sensors"] + geometry["springs"]])
    rising = all(a < b for a, b in zip(nodes, nodes[1:])) and nodes[0] == 0 and abs(nodes[-1] - length) < 1e-8 * length
    checks.true(f"{name}: geometry without gaps", joined and inside and rising, (edges, nodes[:3], nodes[-3:]))
    fits = [result] if "shapes" in result else [result[k] for k in ("today", "base", "extended") if result.get(k)]
    # of several states each has its own
    fits = [state for fit in fits for state in (fit.get("states") or [fit])]
    wrong = [text for fit in fits for text in misdrawn(fit)]
    if fits:
        checks.true(f"{name}: shapes as printed", not wrong, "; ".join(wrong[:3]))


def misdrawn(fit):
    """What is wrong with the shapes of an identification."""
    shapes, rows = fit["shapes"], {n: k for k, n in enumerate(fit["matrix_rows"])}
    for printed, mode in zip(fit["modes"], shapes["modes"], strict=True):
        text = f"mode {printed['measured_mode']}"
        lengths = {len(mode["predicted"]), len(shapes["z_m"]), len(shapes["sensor_id"])}
        if len(lengths) > 1 or len(mode["predicted_axis"]) != len(shapes["axis_z_m"]):
            yield f"{text}: lengths {lengths}"
        if any(len(m["z_m"]) != len(m["shape"]) for m in mode["tierods"] + mode["bars"]):
            yield f"{text}: lengths of members"
        if not mode["measured"]:
            if abs(max(map(abs, mode["predicted_axis"])) - 1) > 1e-8 and len(shapes["axis_z_m"]) < 401:
                yield f"{text}: largest {max(map(abs, mode['predicted_axis']))}"
            continue
        pairs = [(a, b) for a, b in zip(mode["measured"], mode["predicted"], strict=True) if a is not None]
        if max(a for a, _ in pairs) != 1 or min(a for a, _ in pairs) < -1:
            yield f"{text}: largest measured component {max(a for a, _ in pairs)}"
        if printed["mac"] is None:
            continue
        ab, aa, bb = (sum(x) for x in zip(*((a * b, a * a, b * b) for a, b in pairs)))
        row = rows[printed["measured_mode"]]
        for key, matrix in (("mac", fit["mac_matrix"]), ("nco", fit["nco_matrix"])):
            if matrix and abs(matrix[row][fit["matrix_columns"].index(printed["mode"])] - printed[key]) > 1e-7:
                yield f"{text}: {key} {printed[key]} and {matrix[row]}"
        if abs(ab * ab / (aa * bb) - printed["mac"]) > 1e-6:
            yield f"{text}: MAC {ab * ab / (aa * bb)} for {printed['mac']}"


def synthesise(checks, schema, folder):
    """rotid frf without measured functions, beside its own output as measured ones, and with more values than JSON carries."""
    functions, deck = folder / "functions.uff", INPUT / "paper_rotor.inp"
    alone = run(checks, "frf, the paper's Figure 15", schema, "frf", deck, ("-o", functions), (0,))
    checks.true("frf, Figure 15 has curves", alone and alone["with_curves"] and len(alone["functions"][0]["frequency_hz"]) == alone["lines"], "")
    beside = folder / "beside.inp"
    beside.write_text(re.sub(r"\*FRF.*\n19, 1\n", f"*FRF, FILE={functions}\n", deck.read_text()))
    both = run(checks, "frf, its own output as the measured functions", schema, "frf", beside, (), (0,))
    checks.true("frf agrees with its own output", both and abs(both["agreement"]["frac"] - 1) < 1e-6, both and both["agreement"])
    many = run(checks, "frf, more values than JSON carries", schema, "frf", INPUT / "solid_rotor.inp",
               ("--set", "FRF.DAMPING=0.01", "--set", "FRF.LINES=20000"), (0,))
    checks.true("frf says that the curves are left out", many and not many["with_curves"] and many["warnings"], "")
    functions.unlink()
    beside.unlink()


def export(checks, schema, folder):
    """rotid export in every format: fitted, as the deck states it, condensed, and with too few sensors for that."""
    for kind, options in (("matrix-market", ()), ("dmig", ()), ("dmig", ("--condensed",)), ("dmig", ("--start",))):
        out = run(checks, f"export {kind} {' '.join(options)}", schema, "export", INPUT / "paper_rotor.inp",
                  ("--format", kind, "-o", folder / "model", *options), (0,))
        checks.true(f"export {kind} names what it wrote", out and all(Path(name).exists() for name in out["files"]), out and out["files"])
        for name in out["files"] if out else ():
            Path(name).unlink()
    deck = folder / "few.inp"
    deck.write_text(SHAFT + "*SENSORS\n1, 0.3\n2, 0.9\n")
    out = run(checks, "export dmig --condensed, few sensors", schema, "export", deck, ("--format", "dmig", "--condensed", "-o", folder / "model"), (0,))
    checks.true("export has null for modes that the condensed model lacks", out and out["exported_hz"][-1] is None, out and out["exported_hz"])
    deck.write_text(SHAFT + "*SENSORS\n1, 0.3\n")
    run(checks, "export dmig --condensed, one sensor", schema, "export", deck, ("--format", "dmig", "--condensed", "-o", folder / "none"), (2,))
    checks.true("export that is refused writes nothing", not (folder / "none").exists(), "")
    run(checks, "export, without a standard rotor", schema, "export", INPUT / "brake_reuss_beam.inp", ("--format", "dmig", "-o", folder / "model"), (0, 1))
    deck.unlink()
    (folder / "model").unlink()


def extract(checks, schema, folder):
    """rotid ema on three transfer functions of a measured beam: as it is, with a frequency for each point, by quadrature picking, and in
    a band that holds no mode. Without stated noise the modes of the last method count as weak, exit code 1."""
    beam, written = ROOT / "tests" / "data" / "uff" / "beam_excerpt.uff", folder / "modes.uff"
    plain = run(checks, "ema, measured beam", schema, "ema", beam, ("-o", written), (0,))
    checks.true("ema names the file that it wrote", plain and plain["output"] == str(written) and written.exists(), plain and plain["output"])
    checks.true("ema without --per-point has no frequencies at points", plain and not point_frequencies(plain), "")
    points = run(checks, "ema --per-point", schema, "ema", beam, ("--per-point",), (0,))
    checks.true("ema --per-point has frequencies at points", points and any(f is not None for f in point_frequencies(points)), "")
    picked = run(checks, "ema --method quadrature", schema, "ema", beam, ("--method", "quadrature"), (0, 1))
    checks.true("ema --method quadrature has no stabilisation table", picked and picked["modes"] and not picked["stabilisation"], "")
    empty = run(checks, "ema, no mode in the band", schema, "ema", beam, ("--band", "740,930"), (1,))
    checks.true("ema without a mode writes none", empty and not empty["modes"] and empty["output"] is None, empty and empty["modes"])
    written.unlink()


# a rotor that is found everywhere, beside decks that are not
STUDIES = {
    "decks": ("*STUDY\n*DECKS\n{input}/paper_rotor.inp\n{input}/missing.inp\n{input}/solid_steel.inp\n*STARTS, SPREAD=0.3, COUNT=2\n", 1),
    "every axis": (
        "*STUDY, REPLICATES=2, BASELINE=YES\n*DECKS\n{input}/paper_rotor.inp\n*VARIANT, NAME=a\n*VARIANT, NAME=b\nFIT.TIE=E:G\n*MODES\n1-2\n1-5\n"
        "*SENSORS\nALL\n20\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1e11, 1.2e11\n*NOISE\n0.001\n0.002, 0.01\n*HIDE, TYPE=NONE\n"
        "*HIDE, TYPE=stiffness, GROUP=left\nfactor, 0.9, 1.1\n", 0),
    "diagnoses": (
        "*STUDY, COMMAND=DIAGNOSE\n*DECKS\n{input}/paper_rotor.inp\n*SENSORS\nEVERY, 3\n*DATA, SOURCE=MODEL\n*NOISE\n0.001, 0.01\n"
        "*HIDE, TYPE=NONE\n*HIDE, TYPE=added_mass\nmass, 15\nz, left.start, left.end\n*HIDE, TYPE=sensor_gain, SENSOR=25\ngain, 1.5\n"
        "*HIDE, TYPE=noise_level, AT=SHAPE\nfactor, 3\n", 0),
    "diagnoses of measured data": ("*STUDY, COMMAND=DIAGNOSE\n*DECKS\n{input}/solid_rotor.inp\n", 0),
}


def study(checks, summary, line, folder):
    """rotid study: every line of its file and its summary."""
    plan, results = folder / "study.plan", folder / "study.jsonl"
    for name, (text, wanted) in STUDIES.items():
        plan.write_text(text.format(input=INPUT))
        code, out, err = rotid("study", plan, "-o", results, "--json", "-")
        whole = validate(checks, f"study, {name}", summary, out)
        lines = results.read_text().splitlines()
        wrong = [f"line {i}: {e.message}" for i, value in enumerate(map(parse, lines)) for e in line.iter_errors(value)]
        checks.true(f"study, {name}: every line", code == wanted and not wrong and whole and len(lines) == whole["runs"] + 1, [code, err[:200], *wrong][:3])
        results.unlink()
    plan.unlink()


def point_frequencies(result):
    return [point["frequency_hz"] for mode in result["modes"] for point in mode["shape"] if "frequency_hz" in point]


def walk(schema, path=""):
    """Every subschema with its path."""
    yield path, schema
    for name, value in schema.get("properties", {}).items():
        yield from walk(value, f"{path}/{name}")
    for name, value in schema.get("$defs", {}).items():
        yield from walk(value, f"{path}/$defs/{name}")
    if isinstance(schema.get("items"), dict):
        yield from walk(schema["items"], f"{path}[]")


if __name__ == "__main__":
    main()

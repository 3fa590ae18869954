#!/usr/bin/env python3
"""Effects hidden in solids drawn at random, by another program than rotid's, and what `rotid diagnose` makes of them, with MODEL=SOLID
and with MODEL=BEAM. A case has its files in the folder OUT/SEED; a result there that is newer than the program is not computed again.
`--coverage N`: N noise draws on one rotor without an effect, and how often its moduli lie inside their 95 % intervals."""
import argparse
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True
import hide  # first: it finds tools/solid3d and holds BLAS to one thread
import deck as decks
import draw
import numpy as np
import score
from effects import Effects

VISIBLE = 60  # of chi2: effects worth as much have to be named
MODELS = ("SOLID", "BEAM")
EVIDENT = 20  # of chi2, lost by the beam against the solid: then the steps matter


def rotid(program, command, deck, out, model="SOLID"):
    """The JSON of one run, whole or not there; None where it failed, whose words stand beside `out`."""
    if not out.exists() or out.stat().st_mtime < Path(program).stat().st_mtime:
        out.unlink(missing_ok=True)
        part = out.with_suffix(".part")
        options = ["--no-baseline"] if command == "identify" else ["--threads", "1"]
        done = subprocess.run([program, command, deck, "--set", f"FIT.MODEL={model}", "--quiet", "--json", part, *options],
                              capture_output=True, text=True)
        out.with_suffix(".err").write_text(done.stderr)
        if done.returncode in (0, 1) and not json.loads(part.read_text()).get("interrupted"):
            part.rename(out)
    return json.loads(out.read_text()) if out.exists() else None


def write_case(folder, number, seed):
    """A rotor with its effects; files: the measured deck, the deck without noise, of two effects one deck each, the truth."""
    random, kind = np.random.default_rng([seed, number]), draw.KINDS[number % len(draw.KINDS)]
    lines, name = draw.rotor(random, number % 2)
    path = folder / f"{number:03d}.rotor"
    path.write_text("\n".join(lines) + "\n")
    deck, sensors = decks.read(path), int(random.integers(24, 69))
    pair = draw.PAIRS[number // 5 % len(draw.PAIRS)]
    kinds = {"none": (), "pair": pair}.get(kind, (kind,))
    effects = Effects([draw.effect(random, k, deck, name, sensors) for k in kinds])
    stated = hide.evenly(deck, sensors)
    hz, shapes = hide.solve(deck, effects, stated, 6)

    def put(suffix, seeded, hz, shapes, effects):
        text = hide.text_of(lines, stated, *hide.disturbed(hz, shapes, effects, hide.NOISE, seeded), hide.NOISE)
        (folder / f"{number:03d}.{suffix}.inp").write_text(text)

    put("case", [seed, number, 1], hz, shapes, effects)
    put("exact0", None, hz, shapes, effects)
    for i, effect in enumerate(effects.all if len(effects.all) > 1 else [], 1):
        put(f"exact{i}", None, *hide.solve(deck, Effects([effect]), stated, 6), Effects([effect]))
    truth = hide.truth_of(path.name, deck, effects, stated, hz, hide.NOISE, [seed, number, 1])
    (folder / f"{number:03d}.truth.json").write_text(json.dumps(truth, indent=1))


def worth(folder, number, program, truth):
    """By how much chi2 of the fitted deck exceeds its noise: of everything that is hidden, and of two effects each by itself."""
    found = []
    for path in sorted(folder.glob(f"{number:03d}.exact*.inp")):
        result = rotid(program, "identify", path, path.with_suffix(".json"))
        found.append(result["chi2"] if result else float("nan"))
    return found[0], min(found[1:] or found[:1])


def run_case(folder, number, seed, program, models):
    path = folder / f"{number:03d}.truth.json"
    if not path.exists():
        write_case(folder, number, seed)
    truth = json.loads(path.read_text())
    results = [rotid(program, "diagnose", folder / f"{number:03d}.case.inp", folder / f"{number:03d}.{m}.json", m) if m in models else None
               for m in MODELS]
    row = number, truth, worth(folder, number, program, truth), results
    print(line_of(*row), flush=True)
    return row


def hidden_text(truth):
    return " + ".join(f"{e['id']} {e['target']} " + " ".join(f"{k}={v:.3g}" for k, v in e.items() if k not in ("id", "target"))
                      for e in truth["effects"]) or "nothing"


def of_solid(result, truth):
    return score.outcome(result, truth) if result else "failed"


def of_beam(result, truth):
    return score.outcome(result, truth, ("beam_theory",)) if result else "failed"


def line_of(number, truth, drop, results):
    solid, beam = results
    out = [f"{number:3d}  {of_solid(solid, truth):10}  drop {drop[0]:.0f}" + (f" (least of two {drop[1]:.0f})" if drop[1] != drop[0] else "") +
           f"  hidden: {hidden_text(truth)}"]
    out += [f"     {model}: {score.told(r)}" if r else f"     {model}: no result" for model, r in zip(MODELS, results)]
    if solid:
        out.append("     " + "  ".join(f"{name} {100 * error:+.2f} %{'' if inside else ' OUTSIDE'}"
                                       for name, error, inside in score.moduli(solid, truth)))
    return "\n".join(out)


def report(rows):
    groups = {"nothing hidden": lambda r: not r[1]["effects"], f"one effect, drop {VISIBLE} or more": lambda r: len(r[1]["effects"]) == 1 and
              r[2][1] >= VISIBLE, "one effect, less": lambda r: len(r[1]["effects"]) == 1 and r[2][1] < VISIBLE,
              f"two effects, drop {VISIBLE} or more each": lambda r: len(r[1]["effects"]) > 1 and r[2][1] >= VISIBLE,
              "two effects, one less": lambda r: len(r[1]["effects"]) > 1 and r[2][1] < VISIBLE}
    words = ("right", "in set", "one of two", "missed", "wrong", "failed")
    print(f"\n{'MODEL=SOLID':36}" + "".join(f"{w:>11}" for w in words))
    for name, belongs in groups.items():
        found = [of_solid(r[3][0], r[1]) for r in rows if belongs(r)]
        print(f"{name:36}" + "".join(f"{found.count(w):11d}" for w in words))
    clean = [r for r in rows if r[3][0] and of_solid(r[3][0], r[1]) == "right"]
    inside = [inside for r in clean for _, _, inside in score.moduli(r[3][0], r[1])]
    print(f"E and G inside their 95 % intervals where the verdict is right: {sum(inside)} of {len(inside)}")
    beams = [r for r in rows if r[3][1] and r[3][0]]
    matter = [r for r in beams if r[3][1]["base"]["chi2"] - r[3][0]["base"]["chi2"] >= EVIDENT]
    names = [[c["id"] for c in r[3][1]["verdict"]["causes"]] for r in matter]
    sets = [[c["id"] for c in r[3][1]["verdict"]["alternative_causes"]] for r in matter]
    print(f"MODEL=BEAM: chi2 {EVIDENT} or more above that of the solid in {len(matter)} of {len(beams)}; there beam_theory named "
          f"{sum('beam_theory' in n for n in names)}, in the set {sum('beam_theory' in s for s in sets)}; step_stiffness named "
          f"{sum('step_stiffness' in n for n in names)}; a wrong name {sum(of_beam(r[3][1], r[1]) == 'wrong' for r in matter)}")


def coverage(folder, draws, seed, program, number):
    """One rotor, many noises: identify."""
    random = np.random.default_rng([seed, number])
    lines, _ = draw.rotor(random, number % 2)
    path = folder / "rotor.inp"
    path.write_text("\n".join(lines) + "\n")
    deck, effects = decks.read(path), Effects([])
    stated = hide.evenly(deck, 48)
    hz, shapes = hide.solve(deck, effects, stated, 6)
    truth, inside, errors = hide.truth_of(path, deck, effects, stated, hz, hide.NOISE, seed)["moduli"], {}, {}
    for i in range(draws):
        case = folder / f"draw-{i:03d}.inp"
        case.write_text(hide.text_of(lines, stated, *hide.disturbed(hz, shapes, effects, hide.NOISE, [seed, number, i]), hide.NOISE))
        result = rotid(program, "identify", case, case.with_suffix(".json"))
        for p in result["parameters"]:
            lower, upper = p["ci95"]
            inside[p["name"]] = inside.get(p["name"], 0) + (lower <= truth[p["name"]] <= upper)
            errors.setdefault(p["name"], []).append(100 * (p["value"] / truth[p["name"]] - 1))
    for name, count in inside.items():
        print(f"{name}: inside its 95 % interval {count} of {draws}; error mean {np.mean(errors[name]):+.3f} %, scatter {np.std(errors[name]):.3f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rotid")
    parser.add_argument("out", metavar="OUT")
    parser.add_argument("--cases", type=int, default=30)
    parser.add_argument("--first", type=int, default=0, help="number of the first case (0)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--models", default=",".join(MODELS), help="SOLID,BEAM")
    parser.add_argument("--coverage", type=int, default=0, metavar="N")
    options = parser.parse_args()
    folder = Path(options.out) / str(options.seed)
    folder.mkdir(parents=True, exist_ok=True)
    if options.coverage:
        return coverage(folder, options.coverage, options.seed, options.rotid, options.first)
    with ThreadPoolExecutor(options.jobs) as pool:
        rows = pool.map(lambda n: run_case(folder, n, options.seed, options.rotid, options.models), range(options.first, options.first + options.cases))
        report(list(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())

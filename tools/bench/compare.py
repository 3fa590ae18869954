#!/usr/bin/env python3
"""Speed of identifying paper_rotor: rotid beside SciPy, in one run, one BLAS thread. $1: program, $2: build folder.

Two peers. "plain" is what an engineer writes: assembly in NumPy, all slaves condensed densely, scipy.linalg.eigh for the modes asked for.
"tuned" is scipy_fit.py, which eliminates what never changes once and for all and solves the inverse problem.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import time

import scipy_fit
import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh

REPEAT = 15


class PlainGuyan:
    """Condensed model (11-13), everything formed anew at each evaluation."""

    def __init__(self, rotor):
        self.rotor = rotor
        self.masters = 2 * np.array([round((rotor.nodes - 1) * k / (scipy_fit.POINTS - 1)) for k in range(scipy_fit.POINTS)])
        self.slaves = np.setdiff1d(np.arange(rotor.dofs), self.masters)

    def eigenvalues(self, e, g, modes=6):
        k, m = self.rotor.full(e, g)
        s, c = self.slaves, self.masters
        psi = np.zeros((self.rotor.dofs, c.size))
        psi[c, np.arange(c.size)] = 1
        psi[s] = -cho_solve(cho_factor(k[np.ix_(s, s)]), k[np.ix_(s, c)])
        last = scipy_fit.SUSPENSION + modes - 1
        return eigh(psi.T @ k @ psi, psi.T @ m @ psi, eigvals_only=True, subset_by_index=(scipy_fit.SUSPENSION, last))


def time_peer(model):
    seconds = []
    for _ in range(REPEAT):
        begin = time.perf_counter()
        result = scipy_fit.fit(model)
        seconds.append(time.perf_counter() - begin)
    return result, seconds


def time_rotid(program):
    seconds, whole = [], []
    for _ in range(REPEAT):
        begin = time.perf_counter()
        out = subprocess.run([program, "identify", "input/paper_rotor.inp", "--no-baseline", "--json", "-"], check=True, capture_output=True)
        whole.append(time.perf_counter() - begin)
        result = json.loads(out.stdout)
        seconds.append(result["seconds"])
    x = [p["value"] for p in result["parameters"]]
    return {"e": x[0], "g": x[1], "objective": result["objective"], "evaluations": result["evaluations"]}, seconds, whole


def time_host(folder):
    """MINPACK at the wheel of rotid's model, and the seconds of the factors and solutions of one evaluation; None where it is missing."""
    host = pathlib.Path(folder) / "fit_host"
    if not host.exists():
        return None
    return json.loads(subprocess.run([host, "input/paper_rotor.inp", str(REPEAT)], check=True, capture_output=True).stdout)


def time_nlopt(program):
    """The minimisers of NLopt on the same model: {algorithm: (result, seconds)}; empty without NLopt."""
    found = {}
    for _ in range(3):
        out = subprocess.run([program, "identify", "input/paper_rotor.inp", "--json", "-", "--quiet"], check=True, capture_output=True).stdout
        for row in json.loads(out)["baseline"]:
            result = {"e": row["x"][0], "g": row["x"][1], "objective": row["objective"], "evaluations": row["evaluations"]}
            found.setdefault(row["algorithm"], (result, []))[1].append(row["seconds"])
    return found


def main():
    program = sys.argv[1]
    own, own_seconds, whole = time_rotid(program)
    rows = [("rotid, Levenberg-Marquardt", own, own_seconds)]
    host = time_host(sys.argv[2])
    if host:
        rows += [("MINPACK lmder, rotid's model", host["lmder"], [host["lmder"]["best"], host["lmder"]["median"]])]
    nlopt = time_nlopt(program)
    rows += [("NLopt " + name + ", rotid's model", *nlopt[name]) for name in nlopt]
    rows += [("SciPy lm, plain", *time_peer(PlainGuyan(scipy_fit.Rotor())))]
    rows += [("SciPy lm, tuned", *time_peer(scipy_fit.Guyan(scipy_fit.Rotor())))]
    print(f"identification of paper_rotor, HYBRID + GUYAN, {REPEAT} runs each, one thread; a fit alone, models already built")
    for name, there in (("MINPACK: missing (Debian: libcminpack-dev)", host), ("NLopt: missing (WITH_NLOPT=0)", nlopt)):
        if not there:
            print(name)
    print(f"{'':34}{'best ms':>9}{'median ms':>11}{'evaluations':>13}{'E [Pa]':>16}{'G [Pa]':>16}{'objective':>18}{'ratio of medians':>18}")
    median = statistics.median(own_seconds)
    for name, result, seconds in rows:
        print(f"{name:34}{1e3 * min(seconds):9.2f}{1e3 * statistics.median(seconds):11.2f}{result['evaluations']:13d}{result['e']:16.8e}"
              f"{result['g']:16.8e}{result['objective']:18.10e}{statistics.median(seconds) / median:18.1f}")
    print(f"rotid as a whole process, reading the deck and writing the result: {1e3 * statistics.median(whole):.1f} ms")
    if host:
        least = host["limit_seconds"] * own["evaluations"]
        print(f"the limit: {host['modes']} LU factors and solutions and a Cholesky factor of a band of {host['unknowns']} unknowns, half bandwidth "
              f"3, by LAPACK, {own['evaluations']} times: {1e3 * least:.2f} ms; rotid's fit takes {median / least:.1f} times that")
    # difference quotients leave SciPy up to 2e-4 beside the optimum in G, which the objective does not notice: it judges there
    agree = all(abs(r["objective"] / own["objective"] - 1) < 1e-7 and (name.startswith("SciPy") or (
        abs(r["e"] / own["e"] - 1) < 1e-5 and abs(r["g"] / own["g"] - 1) < 1e-5)) for name, r, _ in rows)
    print("1 passed, 0 failed" if agree else "0 passed, 1 failed")
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())

"""The same fits in NumPy and SciPy. The paper's rotor by tools/bench/scipy_fit.py, which shares no code with rotid; the solid rotor, with
shapes and noise, by a chain of the same elements built here."""
import sys
from pathlib import Path

from support import INPUT, ROOT, Checks, result, temporary_folder

sys.path.insert(0, str(ROOT / "tools" / "bench"))
import numpy as np
import pyuff
import scipy_fit
from scipy.optimize import least_squares
from scipy.stats import t as student


def relative_change(function, x, step=1e-4):
    """Jacobian with respect to relative changes of x, by central differences."""
    columns = []
    for p in range(len(x)):
        moved = []
        for sign in (1, -1):
            y = np.array(x)
            y[p] *= 1 + sign * step
            moved.append(function(y))
        columns.append((moved[0] - moved[1]) / (2 * step))
    return np.array(columns).T


def values(report):
    return [p["value"] for p in report["parameters"]]


def compare_fit(checks, name, report, x, objective, hz):
    checks.close(f"{name}: objective", [report["objective"]], [objective], 1e-8)
    checks.close(f"{name}: E, G", values(report), x, 1e-5)
    checks.close(f"{name}: frequencies", [m["predicted_hz"] for m in report["modes"]], hz, 1e-6)


def compare_intervals(checks, name, report, covariance, quantile):
    """covariance: of the relative parameters"""
    value = np.array(values(report))
    std = np.sqrt(np.diag(covariance))
    checks.close(f"{name}: standard deviations", [p["std"] for p in report["parameters"]], std * value, 1e-3)
    checks.close(f"{name}: correlation", [report["correlation"][0][1]], [covariance[0, 1] / (std[0] * std[1])], 1e-3)
    for side, sign in ((0, -1), (1, 1)):
        ends = value * (1 + sign * quantile * std)
        checks.close(f"{name}: 95 % interval, {'upper' if side else 'lower'} end", [p["ci95"][side] for p in report["parameters"]], ends, 1e-3,
                     1e-3 * abs(value).max())


def paper_rotor(checks):
    deck = INPUT / "paper_rotor.inp"
    target = (2 * np.pi * scipy_fit.MEASURED_HZ) ** 2
    rods = ("--set", "TIEROD.MODEL=RODS", "--set", "TIEROD.SELF_EQUILIBRATED=YES")
    full = ("--set", "FIT.REDUCTION=NONE")
    for name, model, options in (
        ("paper rotor, GUYAN", scipy_fit.Guyan(scipy_fit.Rotor()), ()),
        ("paper rotor, NONE", scipy_fit.Rotor(), full),
        ("paper rotor, RODS, NONE", scipy_fit.Rotor("RODS", compression=True), rods + full),
        ("paper rotor, RODS, GUYAN", scipy_fit.Guyan(scipy_fit.Rotor("RODS", compression=True)), rods),
    ):
        report, peer = result("identify", deck, "--no-baseline", *options), scipy_fit.fit(model)
        x = [peer["e"], peer["g"]]
        compare_fit(checks, name, report, x, peer["objective"], peer["frequency_hz"])
        jacobian = relative_change(lambda y: 1 - model.eigenvalues(*y) / target, x)
        variance = 2 * peer["objective"] / (target.size - 2)
        compare_intervals(checks, name, report, variance * np.linalg.inv(jacobian.T @ jacobian), student.ppf(0.975, target.size - 2))

    noise = np.array([0.08, 0.20, 0.10, 0.12, 0.09, 0.15])  # unequal, and above the misfit: no widening, the sandwich at work
    with temporary_folder() as folder:
        noisy = Path(folder) / "noisy.inp"
        lines = deck.read_text().splitlines()
        first = lines.index("*MODES") + 1
        for mode, relative in enumerate(noise):
            lines[first + mode] += f", {relative * scipy_fit.MEASURED_HZ[mode]:.12g}"
        noisy.write_text("\n".join(lines) + "\n")
        report = result("identify", noisy, "--no-baseline", expected=(0, 1))
    model = scipy_fit.Guyan(scipy_fit.Rotor())
    peer = scipy_fit.fit(model)
    jacobian = relative_change(lambda y: 1 - model.eigenvalues(*y) / target, [peer["e"], peer["g"]])
    inverse = np.linalg.inv(jacobian.T @ jacobian)
    sandwich = inverse @ jacobian.T @ np.diag((2 * noise) ** 2) @ jacobian @ inverse
    # at the values rotid found: chi2 is not what is minimised, so that it changes with them in the first order, and least_squares
    # stops 1e-6 beside its minimum
    residual = 1 - model.eigenvalues(*(p["value"] for p in report["parameters"])) / target
    checks.close("paper rotor, stated noise: chi2", [report["chi2"], report["intervals_widened_by"]], [((residual / (2 * noise)) ** 2).sum(), 1], 1e-6)
    compare_intervals(checks, "paper rotor, stated noise", report, sandwich, 1.959963984540054)

    report = result("identify", deck)
    for other in report["baseline"]:
        checks.close(f"paper rotor, NLopt {other['algorithm']}: objective", [other["objective"]], [report["objective"]], 1e-8)

    at = np.array([8e10, 3e10, 1 / 3])
    report = result("sensitivity", deck, "--at", "core.E=8e10,core.G=3e10,core.nu=0.3333333333333333")
    reference = model.eigenvalues(*at)
    for p, parameter in enumerate(report["parameters"]):
        moved = np.array(at)
        moved[p] *= 1.01
        checks.close(f"paper rotor, sensitivity to {parameter['name']}", parameter["sensitivity"],
                     (1 - model.eigenvalues(*moved) / reference) / 0.01, 1e-6, 1e-8)
    report = result("modes", deck)
    hz = {kind: np.sqrt(other.eigenvalues(1.157e11, 0.316e11)) / (2 * np.pi)
          for kind, other in (("full_hz", scipy_fit.Rotor()), ("reduced_hz", model))}
    for kind in hz:
        checks.close(f"paper rotor, modes: {kind}", [m[kind] for m in report["modes"]], hz[kind], 1e-8)
    fine = np.sqrt(scipy_fit.Rotor(refine=2).eigenvalues(1.157e11, 0.316e11)) / (2 * np.pi)
    limit = fine + (fine - hz["full_hz"]) / 3
    checks.close("paper rotor, modes: mesh error", [m["mesh_error_percent"] for m in report["modes"]], 100 * (hz["full_hz"] / limit - 1), 1e-3, 1e-6)


class SolidRotor:
    """input/solid_rotor.inp: a chain on springs, with a node at every measured point."""

    sections = ((0.25, 0.14, 24), (0.25, 0.20, 24), (0.20, 0.26, 19), (0.70, 0.36, 66), (0.20, 0.26, 19), (0.23, 0.18, 22), (0.20, 0.13, 19))
    core = 3

    def __init__(self, points):
        nodes, owner, z = [], [], 0.0
        for section, (length, _, count) in enumerate(self.sections):
            nodes += [z + length * e / count for e in range(count)]
            owner += [section] * count
            z += length
        nodes.append(z)
        for point in sorted(points):  # a node nearer than 1 % of an element stands for the point
            i = min(np.searchsorted(nodes, point, side="right") - 1, len(owner) - 1)
            length, _, count = self.sections[owner[i]]
            if min(point - nodes[i], nodes[i + 1] - point) > 0.01 * length / count:
                nodes.insert(i + 1, point)
                owner.insert(i + 1, owner[i])
        self.z, self.owner = np.array(nodes), owner
        self.masters = 2 * np.array([np.argmin(abs(self.z - point)) for point in points])

    def modes(self, e, g, count):
        n = 2 * self.z.size
        k, m = np.zeros((n, n)), np.zeros((n, n))
        for i, section in enumerate(self.owner):
            material = (e, g, 0.28, 7650.0) if section == self.core else (2.1e11, 2.1e11 / 2.6, 0.30, 7850.0)
            area, inertia = scipy_fit.disc(self.sections[section][1])
            # Cowper's 6 (1 + nu)/(7 + 6 nu) is 6/(7 - 2 x) with x = nu G/E, of sheets their own nu and E (1.9e11 Pa)
            kappa = 6 / (7 - 2 * material[2] * g / 1.9e11) if section == self.core else scipy_fit.shear_coefficient(material[2])
            pair = scipy_fit.element(material[0], material[1], kappa, material[3], area, inertia,
                                     self.z[i + 1] - self.z[i])
            place = slice(2 * i, 2 * i + 4)
            k[place, place] += pair[0]
            m[place, place] += pair[1]
        k[0, 0] += 9790
        k[-2, -2] += 2000
        mu, phi = scipy_fit.eigh(m, k + scipy_fit.SHIFT * m, driver="gvd")
        lowest = slice(-3, -3 - count, -1)
        return 1 / mu[lowest] - scipy_fit.SHIFT, phi[self.masters, lowest]


def solid_rotor(checks):
    sets = pyuff.UFF(str(INPUT / "data" / "converged_rotor_uniform.uff")).read_sets()
    nodes = next(s for s in sets if s["type"] == 15)
    shapes = [s for s in sets if s["type"] == 55]
    place = {int(label): i for i, label in enumerate(nodes["node_nums"])}
    measured = np.array([[s["r1"][list(s["node_nums"]).index(label)] for label in place] for s in shapes]).T
    measured = measured / abs(measured).max(axis=0)
    hz = np.array([s["freq"] for s in shapes])
    model = SolidRotor(np.array(nodes["z"]))

    def residual(x):
        lam, phi = model.modes(*x, hz.size)
        scale = (phi * measured).sum(axis=0) / (phi**2).sum(axis=0)
        return np.r_[(np.sqrt(lam) / (2 * np.pi * hz) - 1) / 0.001, ((scale * phi - measured) / 0.015).T.ravel()]

    start = np.array([0.6e11, 0.3e11])
    found = least_squares(lambda y: residual(y * start), [1.0, 1.0], method="lm", jac="3-point", xtol=1e-13, ftol=1e-13, gtol=1e-13)
    x = found.x * start
    report = result("identify", INPUT / "solid_rotor.inp", "--no-baseline", expected=(0, 1))
    name = "solid rotor, LIKELIHOOD"
    compare_fit(checks, name, report, x, found.cost, np.sqrt(model.modes(*x, hz.size)[0]) / (2 * np.pi))
    dof = found.fun.size - 2 - hz.size
    checks.close(f"{name}: chi2 per degree of freedom", [report["dof"], report["chi2_per_dof"]], [dof, 2 * found.cost / dof], 1e-8)
    jacobian = relative_change(residual, x)
    widened = max(1, 2 * found.cost / dof)
    quantile = student.ppf(0.975, dof) if widened > 1 else 1.959963984540054
    compare_intervals(checks, name, report, widened * np.linalg.inv(jacobian.T @ jacobian), quantile)
    checks.close(f"{name}: singular value ratio", [report["condition_number"]], [np.linalg.cond(jacobian)], 1e-4)


def main():
    checks = Checks()
    paper_rotor(checks)
    solid_rotor(checks)
    checks.end()


if __name__ == "__main__":
    main()

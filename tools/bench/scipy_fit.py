#!/usr/bin/env python3
"""The paper_rotor identification in NumPy/SciPy: the peer of the speed benchmark and a second opinion on numbers.

Shares no code with rotid. Timoshenko chain, tie rods as one element, Guyan reduction onto 68 lateral points,
E and G of the core from six frequencies by scipy.optimize.least_squares(method="lm").
"""
import os

# One thread, as rotid runs. BLAS reads this once, so it must precede the NumPy import.
for _name in ("OPENBLAS", "OMP", "MKL", "BLIS"):
    os.environ[_name + "_NUM_THREADS"] = "1"

import argparse
import json
import platform
import statistics
import time

import numpy as np
import scipy
from scipy.linalg import cho_factor, cho_solve, eigh
from scipy.optimize import least_squares
from scipy.sparse import csr_array

# Provenance. Measured frequencies: paper, Table 3 (real). Core nu and start: paper, section 5.2. Springs: paper, equation 44
# for 998 kg, rounded. Geometry, densities, tie rods, point positions: stated surrogate of input/paper_rotor.inp (the paper has none).
MEASURED_HZ = np.array([435.55, 735.16, 1159.4, 1802.0, 2425.8, 2918.4])
SECTIONS = (  # length [m], diameter [m], elements
    (0.132750, 0.098602, 14), (0.123268, 0.197920, 13), (0.123268, 0.228314, 13), (0.123268, 0.193377, 13),
    (0.047411, 0.290272, 5), (0.075857, 0.334859, 8), (0.924192, 0.334092, 50), (0.065083, 0.334859, 8),
    (0.032542, 0.170497, 4), (0.097625, 0.211909, 12), (0.097625, 0.259863, 12), (0.097625, 0.169163, 12),
    (0.089489, 0.145809, 11))
CORE = 6  # index of the laminated core in SECTIONS
STEEL_E, STEEL_NU, STEEL_RHO = 2.1e11, 0.3, 7850.0
STEEL_G = STEEL_E / (2 * (1 + STEEL_NU))
CORE_NU, CORE_RHO = 0.28, 7380.66
RODS, ROD_D, ROD_RADIUS, ROD_TENSION = 12, 0.032, 0.13364, 150e3
SPRING_START, SPRING_END = 9790.0, 2000.0
POINTS = 68
START = np.array([0.6e11, 0.3e11])
SUSPENSION = 2  # modes of the rotor on its sling, below the first bending mode
SHIFT = 1e8  # [rad2/s2], within the range of the measured modes


def shear_coefficient(nu, a=0.0):
    """Cowper's k, (A.3); a is the inner over the outer diameter."""
    b = (1 + a * a) ** 2
    return 6 * (1 + nu) * b / ((7 + 6 * nu) * b + (20 + 12 * nu) * a * a)


def element(e, g, k, rho, s, i, l, force=0.0):
    """4x4 stiffness and mass (A.1, corrected A.4, B.1, B.2) for {v, theta, v, theta} with theta = -dv/dx."""
    p = 12 * e * i / (g * k * s * l * l)
    q = p * p
    c = e * i / ((1 + p) * l**3)
    f = force / (60 * (1 + p) ** 2 * l)
    a, b = 12 * c + f * (72 + 120 * p + 60 * q), 6 * l * (c + f)
    d = l * l * (c * (4 + p) + f * (8 + 10 * p + 5 * q))
    h = l * l * (c * (2 - p) - f * (2 + 10 * p + 5 * q))
    stiffness = np.array([[a, -b, -a, -b], [-b, d, b, h], [-a, b, a, b], [-b, h, b, d]])
    u = rho * s * l / (840 * (1 + p) ** 2)
    w = rho * i * l / (840 * (1 + p) ** 2)
    r11 = w * 1008 / (l * l)
    r12 = w * (420 * p - 84) / l
    m11 = u * (312 + 588 * p + 280 * q) + r11
    m12 = -u * (44 + 77 * p + 35 * q) * l + r12
    m13 = u * (108 + 252 * p + 140 * q) - r11
    m14 = u * (26 + 63 * p + 35 * q) * l + r12
    m22 = u * (8 + 14 * p + 7 * q) * l * l + w * (112 + 140 * p + 280 * q)
    m24 = -u * (6 + 14 * p + 7 * q) * l * l - w * (28 + 140 * p - 140 * q)
    mass = np.array([[m11, m12, m13, m14], [m12, m22, -m14, m24], [m13, -m14, m11, -m12], [m14, m24, -m12, m22]])
    return stiffness, mass


def disc(d):
    """Area and second moment of a full circle."""
    return np.pi * d**2 / 4, np.pi * d**4 / 64


def tie_element(model, l):
    """Stiffness and mass of all tie rods between the two ends of the core.

    TUBE is the paper's equivalent cylinder (6, corrected 7). RODS lets slender rods do only what they can: stretch under
    the relative rotation of the ends, and bend each about its own axis.
    """
    s, own = (RODS * value for value in disc(ROD_D))
    steiner = s * ROD_RADIUS**2 / 2
    if model == "TUBE":
        i = own + steiner
        a = np.sqrt((8 * i / s - 2 * s / np.pi) / (8 * i / s + 2 * s / np.pi))
        k = shear_coefficient(STEEL_NU, a)
        return element(STEEL_E, STEEL_G, k, STEEL_RHO, s, i, l, RODS * ROD_TENSION)
    stiffness, mass = element(STEEL_E, STEEL_G, shear_coefficient(STEEL_NU), STEEL_RHO, s, own, l, RODS * ROD_TENSION)
    turn = np.ix_((1, 3), (1, 3))
    stiffness[turn] += STEEL_E * steiner / l * np.array([[1, -1], [-1, 1]])
    mass[turn] += STEEL_RHO * steiner * l / 6 * np.array([[2, 1], [1, 2]])
    return stiffness, mass


def lowest(k, m, modes):
    """Elastic eigenvalues, suspension modes left out.

    Solved as M x = mu (K + s M) x, lambda = 1/mu - s: the wanted values are then the large ones. With K x = lambda M x their
    rounding scatter is 40 times larger, and difference quotients of it made MINPACK stop 2e-5 beside the optimum in G.
    All values by dsygvd take less time than six by dsygvx (subset_by_index) at this size.
    """
    mu = eigh(m, k + SHIFT * m, eigvals_only=True, driver="gvd", overwrite_a=True, overwrite_b=True, check_finite=False)
    return 1 / mu[::-1][SUSPENSION:SUSPENSION + modes] - SHIFT


class Rotor:
    """Everything that does not depend on E and G of the core, and the core element that does."""

    def __init__(self, tie="TUBE", compression=False, refine=1):
        counts = [n * refine for _, _, n in SECTIONS]
        first = np.cumsum([0] + counts)
        self.nodes = int(first[-1]) + 1
        self.dofs = 2 * self.nodes
        self.k0 = np.zeros((self.dofs, self.dofs))  # without core and tie rods
        self.m0 = np.zeros((self.dofs, self.dofs))
        for section, (length, d, _) in enumerate(SECTIONS):
            chain = 2 * np.arange(first[section], first[section + 1])[:, None] + np.arange(4)
            if section == CORE:
                self.core_dofs, self.core_l, self.core_d = chain, length / counts[CORE], d
                continue
            k, m = element(STEEL_E, STEEL_G, shear_coefficient(STEEL_NU), STEEL_RHO, *disc(d), length / counts[section])
            self.add(self.k0, chain, k)
            self.add(self.m0, chain, m)
        self.k0[0, 0] += SPRING_START
        self.k0[-2, -2] += SPRING_END
        self.tie_dofs = np.r_[self.core_dofs[0, :2], self.core_dofs[-1, 2:]]
        self.tie_k, self.tie_m = tie_element(tie, SECTIONS[CORE][0])
        # Rods in tension press on what they clamp; the paper's model leaves that out.
        self.core_force = -RODS * ROD_TENSION if compression else 0.0

    @staticmethod
    def add(matrix, chain, block):
        np.add.at(matrix, (chain[:, :, None], chain[:, None, :]), block)

    def core(self, e, g, nu=CORE_NU):
        """All core elements are equal: one 4x4 pair serves them all."""
        return element(e, g, shear_coefficient(nu), CORE_RHO, *disc(self.core_d), self.core_l, self.core_force)

    def full(self, e, g, nu=CORE_NU):
        """Dense K and M of the whole model."""
        pair = []
        for constant, core, tie in zip((self.k0, self.m0), self.core(e, g, nu), (self.tie_k, self.tie_m)):
            matrix = constant.copy()
            self.add(matrix, self.core_dofs, core)
            matrix[np.ix_(self.tie_dofs, self.tie_dofs)] += tie
            pair.append(matrix)
        return pair

    def eigenvalues(self, e, g, nu=CORE_NU, modes=6):
        """Elastic eigenvalues of the whole model."""
        return lowest(*self.full(e, g, nu), modes)


class Guyan:
    """Condensed model (11-13).

    Slaves outside the core never change, so they are eliminated once; condensing in two steps gives the same matrices.
    An evaluation eliminates only the slaves of the core. Of the ways tried (dense Cholesky or band solver with a low-rank
    tie on all 284 slaves), this is the fastest in NumPy.
    """

    def __init__(self, rotor):
        self.rotor = rotor
        masters = 2 * np.array([round((rotor.nodes - 1) * k / (POINTS - 1)) for k in range(POINTS)])
        inner = np.setdiff1d(rotor.core_dofs, masters)
        kept = np.r_[inner, masters]
        fixed = np.setdiff1d(np.arange(rotor.dofs), kept)
        k, m = rotor.k0.copy(), rotor.m0.copy()
        tie = np.ix_(rotor.tie_dofs, rotor.tie_dofs)
        k[tie] += rotor.tie_k
        m[tie] += rotor.tie_m
        psi = np.zeros((rotor.dofs, kept.size))
        psi[kept, np.arange(kept.size)] = 1
        psi[fixed] = -cho_solve(cho_factor(k[np.ix_(fixed, fixed)]), k[np.ix_(fixed, kept)])
        self.k0, self.m0 = psi.T @ k @ psi, psi.T @ m @ psi
        self.ns = inner.size
        self.psi = np.vstack([np.zeros((inner.size, POINTS)), np.eye(POINTS)])
        # Sparse map from the 16 entries of the core element to the places they are added to.
        place = np.zeros(rotor.dofs, int)
        place[kept] = np.arange(kept.size)
        chain = place[rotor.core_dofs]
        spot = (chain[:, :, None] * kept.size + chain[:, None, :]).reshape(-1, 16)
        self.spot, row = np.unique(spot, return_inverse=True)
        column = np.broadcast_to(np.arange(16), spot.shape)
        self.map = csr_array((np.ones(spot.size), (row.ravel(), column.ravel())), shape=(self.spot.size, 16))

    def matrices(self, e, g, nu=CORE_NU):
        """Condensed K and M."""
        ns, psi, k, m = self.ns, self.psi, self.k0.copy(), self.m0.copy()
        for matrix, core in zip((k, m), self.rotor.core(e, g, nu)):
            matrix.ravel()[self.spot] += self.map @ core.ravel()
        factor = cho_factor(k[:ns, :ns], check_finite=False)
        psi[:ns] = -cho_solve(factor, k[:ns, ns:], check_finite=False)
        return k[ns:, ns:] + k[ns:, :ns] @ psi[:ns], psi.T @ (m @ psi)

    def eigenvalues(self, e, g, nu=CORE_NU, modes=6):
        """Elastic eigenvalues of the condensed model."""
        return lowest(*self.matrices(e, g, nu), modes)


def fit(model, measured_hz=MEASURED_HZ, start=START, tolerance=1e-12):
    """E, G and every quantity of the fit; residual 1 - lambda/w^2, variables scaled by their start."""
    target = (2 * np.pi * measured_hz) ** 2
    count = 0

    def residual(x):
        nonlocal count  # counted here: what SciPy calls nfev depends on method and version
        count += 1
        return 1 - model.eigenvalues(*(x * start), modes=target.size) / target

    found = least_squares(residual, np.ones(2), method="lm", ftol=tolerance, xtol=tolerance, gtol=tolerance)
    e, g = found.x * start
    hz = measured_hz * np.sqrt(1 - found.fun)
    return {"e": float(e), "g": float(g), "objective": float(found.cost), "frequency_hz": hz.tolist(),
            "error_percent": (100 * (hz / measured_hz - 1)).tolist(), "evaluations": count, "jacobian": found.jac}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=1, help="fits to time in this process")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    model = Guyan(Rotor())
    seconds = []
    for _ in range(max(1, options.repeat)):
        begin = time.perf_counter()
        result = fit(model)
        seconds.append(time.perf_counter() - begin)
    report = {key: result[key] for key in ("e", "g", "objective", "frequency_hz", "evaluations")}
    report |= {"seconds_best": min(seconds), "seconds_median": statistics.median(seconds),
               "python": platform.python_version(), "numpy": np.__version__, "scipy": scipy.__version__}
    if options.json:
        print(json.dumps(report))
        return
    print(f"E {result['e']:.9e} Pa   G {result['g']:.9e} Pa   objective {result['objective']:.9e}")
    for mode, row in enumerate(zip(MEASURED_HZ, result["frequency_hz"], result["error_percent"]), 1):
        print("mode {}   measured {:8.2f} Hz   model {:14.8f} Hz   error {:+8.4f} %".format(mode, *row))
    print(f"evaluations {result['evaluations']}   best {min(seconds):.6f} s   median {report['seconds_median']:.6f} s")


if __name__ == "__main__":
    main()

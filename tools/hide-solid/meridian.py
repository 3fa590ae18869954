"""Bending of a body of revolution by elements of high order: rectangles of the meridian (r, z) with Lagrange polynomials of degree
ORDER in both directions on Gauss-Lobatto points. u_r = U cos t, u_t = V sin t, u_z = W cos t. The rectangles shrink geometrically
towards re-entrant corners. Shares no code and no element with src/solid."""
import math

import numpy as np
import scipy.sparse as sparse
from numpy.polynomial import legendre
from scipy.sparse.linalg import LinearOperator, eigsh, splu

ORDER = 4
LARGEST = 0.08  # m
CORNER = 0.001  # m: rectangles at a re-entrant corner are at most this long
RATIO = 0.15  # of an element to the next one away from a corner
TOUCH = 1e-9  # m


class Basis:
    """Lagrange polynomials on [-1, 1]: values and slopes at Gauss points."""

    def __init__(self, order):
        inside = legendre.legroots(legendre.legder([0] * order + [1]))
        self.nodes = np.concatenate(([-1.0], np.sort(inside.real), [1.0]))
        self.coefficients = np.linalg.inv(legendre.legvander(self.nodes, order))
        self.gauss, self.weight = legendre.leggauss(order + 2)
        self.value, self.slope = self.at(self.gauss), self.slope_at(self.gauss)

    def at(self, x):
        return legendre.legval(x, self.coefficients, tensor=True).T.reshape(np.size(x), -1)

    def slope_at(self, x):
        return legendre.legval(x, legendre.legder(self.coefficients), tensor=True).T.reshape(np.size(x), -1)


def distinct(values):
    kept = []
    for value in sorted(values):
        if not kept or value - kept[-1] > TOUCH:
            kept.append(value)
    return kept


def lines(places, corners, largest, corner):
    """Lines at all places; intervals of at most `largest`, those that begin or end at a corner cut down to `corner`."""
    found = [places[0]]
    for a, b in zip(places, places[1:]):
        part = list(np.linspace(a, b, max(1, math.ceil((b - a) / largest - TOUCH)) + 1))
        near = [min(abs(x - c) for c in corners) < TOUCH if corners else False for x in (a, b)]
        if all(near) and len(part) == 2 and b - a > corner:
            part.insert(1, (a + b) / 2)
        while near[0] and part[1] - a > corner:
            part.insert(1, a + RATIO * (part[1] - a))
        while near[1] and b - part[-2] > corner:
            part.insert(-1, b - RATIO * (b - part[-2]))
        found += part[1:]
    return np.array(found)


def compliance(material, e, g, joint):
    """rr, tt, zz, rz, rt, tz. `e` and `g` are factors on the moduli along the axis; of an isotropic part they act on the plane as
    well. `joint` [1/Pa] adds to the strain along the axis by stress along it."""
    plane = material.plane_e if material.laminated else material.plane_e * e
    axial = material.axial_e * e
    nu = material.axial_nu * e if material.laminated else material.axial_nu
    s = np.zeros((6, 6))
    s[0, 0] = s[1, 1] = 1 / plane
    s[0, 1] = s[1, 0] = -material.plane_nu / plane
    s[2, 2] = 1 / axial + joint
    s[0, 2] = s[2, 0] = s[1, 2] = s[2, 1] = -nu / axial
    s[3, 3] = s[5, 5] = 1 / (material.axial_g * g)
    s[4, 4] = 2 * (1 + material.plane_nu) / plane
    return s


class Meridian:
    """K and M of a deck of tools/solid3d with the change of `effects`, and the modes."""

    def __init__(self, deck, effects, order=ORDER, largest=LARGEST, corner=CORNER):
        self.deck, self.effects, self.basis = deck, effects, Basis(order)
        steps = [(b.z, min(max(r[1] for r in a.rings), max(r[1] for r in b.rings)))
                 for a, b in zip(deck.sections, deck.sections[1:]) if sorted(a.rings) != sorted(b.rings)]
        ends = [s.z for s in deck.sections] + [deck.length] + [z for z, _ in deck.springs]
        self.z = lines(distinct(ends + effects.lines(deck)), [z for z, _ in steps], largest, corner)
        radii = distinct(r for s in deck.sections for ring in s.rings for r in ring[:2])
        self.r = lines(radii, [r for _, r in steps], largest, corner)
        self.number, self.at = {}, []  # nodes by their place on the fine grid of all lines
        self.slices = []  # for each slice in z: element numbers of nodes, outermost last
        self.k, self.m = self.assemble()

    def points(self, grid):
        """Places of all nodes along one direction."""
        half, middle = np.diff(grid) / 2, (grid[1:] + grid[:-1]) / 2
        inside = middle[:, None] + half[:, None] * self.basis.nodes[None, :-1]
        return np.append(inside.ravel(), grid[-1])

    def nodes_of(self, i, j):
        """Node numbers of the element i in r, j in z; r runs first."""
        n = len(self.basis.nodes)
        keys = [(i * (n - 1) + a, j * (n - 1) + b) for b in range(n) for a in range(n)]
        return np.array([self.number.setdefault(key, len(self.number)) for key in keys])

    def element(self, i, j, section, ring):
        """K and M of one rectangle: degrees of freedom U, V, W of a node behind each other."""
        basis, (r0, r1), (z0, z1) = self.basis, self.r[i:i + 2], self.z[j:j + 2]
        material = self.deck.materials[section.rings[ring][2]]
        n = len(basis.nodes)**2
        r, z = (r0 + r1) / 2 + (r1 - r0) / 2 * basis.gauss, (z0 + z1) / 2 + (z1 - z0) / 2 * basis.gauss
        value = np.kron(basis.value, basis.value)  # (point, node)
        dr = np.kron(basis.value, basis.slope) * 2 / (r1 - r0)
        dz = np.kron(basis.slope, basis.value) * 2 / (z1 - z0)
        radius = np.tile(r, len(z))
        over = value / radius[:, None]
        b = np.zeros((len(radius), 6, 3 * n))
        b[:, 0, 0::3] = dr
        b[:, 1, 0::3] = b[:, 1, 1::3] = over
        b[:, 2, 2::3] = dz
        b[:, 3, 0::3], b[:, 3, 2::3] = dz, dr
        b[:, 4, 0::3], b[:, 4, 1::3] = -over, dr - over
        b[:, 5, 1::3], b[:, 5, 2::3] = dz, -over
        weight = math.pi * np.kron(basis.weight, basis.weight) * radius * (r1 - r0) * (z1 - z0) / 4
        fields = [self.effects.field(self.deck, section, ring, x) for x in z]
        elastic = np.repeat([np.linalg.inv(compliance(material, e, g, joint)) for e, g, _, joint in fields], len(r), axis=0)
        rho = material.rho * np.repeat([density for _, _, density, _ in fields], len(r))
        cb = np.matmul(weight[:, None, None] * elastic, b)
        k = np.matmul(b.reshape(-1, 3 * n).T, cb.reshape(-1, 3 * n))
        m = np.kron(value.T @ ((weight * rho)[:, None] * value), np.eye(3))
        return k, m

    def ring_masses(self, add):
        """A mass spread evenly over a strip of the surface: m/2 (U^2 + V^2 + W^2)."""
        n = len(self.basis.nodes)
        for mass, from_, to in self.effects.strips(self.deck):
            for j, (z0, z1) in enumerate(zip(self.z, self.z[1:])):
                if from_ - TOUCH < z0 and z1 < to + TOUCH:
                    edge = self.slices[j][-1][n - 1::n]
                    share = mass / 2 * (z1 - z0) / (to - from_)
                    of_edge = self.basis.value.T @ (self.basis.weight[:, None] / 2 * self.basis.value)
                    add(edge, np.kron(share * of_edge, np.eye(3)))

    def assemble(self):
        rows, columns, ks, ms = [], [], [], []

        def add(nodes, k, m):
            dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
            rows.append(np.repeat(dofs, len(dofs)))
            columns.append(np.tile(dofs, len(dofs)))
            ks.append(k.ravel())
            ms.append(m.ravel())

        for j, z in enumerate((self.z[1:] + self.z[:-1]) / 2):
            section = next(s for s in self.deck.sections if z < s.z + s.length)
            self.slices.append([])
            for i, r in enumerate((self.r[1:] + self.r[:-1]) / 2):
                ring = next((q for q, (inner, outer, _) in enumerate(section.rings) if inner < r < outer), None)
                if ring is not None:
                    self.slices[-1].append(self.nodes_of(i, j))
                    add(self.slices[-1][-1], *self.element(i, j, section, ring))
        self.ring_masses(lambda nodes, m: add(nodes, 0 * m, m))
        r, z = self.points(self.r), self.points(self.z)
        self.at = np.array([(r[a], z[b]) for a, b in self.number])
        for place, stiffness in self.deck.springs:
            here = np.flatnonzero(np.abs(self.at[:, 1] - place) < TOUCH)
            inmost = here[np.argmin(self.at[here, 0])]
            add(np.array([inmost]), np.diag([stiffness, 0, 0]), np.zeros((3, 3)))
        parts = np.concatenate(rows), np.concatenate(columns)
        size = 3 * len(self.number)
        k, m = (sparse.coo_matrix((np.concatenate(v), parts), shape=(size, size)).tocsc() for v in (ks, ms))
        t = self.free(size)
        self.expand = t
        return t.T @ k @ t, t.T @ m @ t

    def free(self, size):
        """On the axis V = -U and W = 0: the columns that are left."""
        axis = np.flatnonzero(self.at[:, 0] < TOUCH)
        t = sparse.lil_matrix(sparse.identity(size))
        for node in axis:
            t[3 * node + 1, 3 * node + 1] = 0
            t[3 * node + 1, 3 * node] = -1
        keep = np.setdiff1d(np.arange(size), np.concatenate((3 * axis + 1, 3 * axis + 2)))
        return t.tocsc()[:, keep]

    def modes(self, count):
        """The lowest `count` elastic frequencies [Hz] and their U, V, W; the two that move the rotor as a body are left out."""
        start = np.cos(np.arange(self.k.shape[0]))  # not ARPACK's random one: the same modes in every run
        shift = -(2 * math.pi * 30)**2  # below zero, where the matrix is positive definite: no pivots, an ordering that keeps it sparse
        factor = splu((self.k - shift * self.m).tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
        inverse = LinearOperator(self.k.shape, factor.solve, dtype=float)
        value, vector = eigsh(self.k, count + 2, self.m, sigma=shift, OPinv=inverse, v0=start, tol=1e-10)
        order = np.argsort(value)[2:]
        return np.sqrt(value[order]) / (2 * math.pi), self.expand @ vector[:, order]

    def surface(self, vector, z):
        """U of the outer surface at z."""
        j = min(max(np.searchsorted(self.z, z, "right") - 1, 0), len(self.z) - 2)
        n = len(self.basis.nodes)
        edge = self.slices[j][-1][n - 1::n]
        x = (2 * z - self.z[j] - self.z[j + 1]) / (self.z[j + 1] - self.z[j])
        return (self.basis.at(np.array([x])) @ vector[3 * edge])[0]

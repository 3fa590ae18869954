"""Twenty-node bricks of one quarter of a rotor: x >= 0, y >= 0. Lines in r lie at every radius, in z at every end of a section
and at every spring; an element at a line behind which the rotor changes is halved until it is as short as asked for. The mesh for
half that length has these lines and one more at each side, so frequencies of meshes form a clean sequence."""
import math
from dataclasses import dataclass, field

QUARTER = 4  # elements around; even: two by two lie about the axis
TOUCH = 1e-9  # m


@dataclass
class Mesh:
    nodes: list = field(default_factory=list)  # (x, y, z)
    bricks: dict = field(default_factory=dict)  # material -> lists of 20 nodes in the order of C3D20R, from 0


def lines_between(a, b, graded, largest, corner):
    """Points from a to b: even parts of at most `largest`, the first and last halved down to `corner` where graded says so."""
    count = max(1, math.ceil((b - a) / largest - TOUCH))
    points = [a + (b - a) * i / count for i in range(count + 1)]
    if all(graded) and count == 1 and b - a > corner + TOUCH:
        points.insert(1, (a + b) / 2)
    while graded[0] and points[1] - points[0] > corner + TOUCH:
        points.insert(1, (points[0] + points[1]) / 2)
    while graded[1] and points[-1] - points[-2] > corner + TOUCH:
        points.insert(-1, (points[-1] + points[-2]) / 2)
    return points


def graded_lines(places, is_graded, largest, corner):
    points = [places[0]]
    for a, b in zip(places, places[1:]):
        points += lines_between(a, b, (is_graded(a), is_graded(b)), largest, corner)[1:]
    return points


def distinct(values):
    kept = []
    for value in sorted(values):
        if not kept or value - kept[-1] > TOUCH:
            kept.append(value)
    return kept


def radii_of(deck):
    return distinct(r for s in deck.sections for inner, outer, _ in s.rings for r in (inner, outer))


class Plane:
    """The cross-section: eight-node quadrilaterals with the radius that says to which ring each belongs."""

    def __init__(self, deck, largest, corner):
        self.points, self.number, self.quads = [], {}, []  # quads: (radius inside, 8 points)
        radii = radii_of(deck)
        solid = radii[0] == 0
        self.first = radii[1] if solid else radii[0]
        self.half = 0.5 * self.first if solid else 0.0
        # the radius of the largest surface is no re-entrant corner, nor is the axis
        lines = graded_lines(radii[1:] if solid else radii, lambda r: TOUCH < r < radii[-1] - TOUCH, largest, corner)
        if solid:
            self.square()
            # from the square to the first radius, as if r went from half of it
            lines = lines_between(self.half, self.first, (False, len(lines) > 1), largest, corner)[:-1] + lines
        for inner, outer in zip(lines, lines[1:]):
            self.ring(inner, outer)

    def add(self, x, y):
        key = (round(x / TOUCH), round(y / TOUCH))
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append((x if key[0] else 0.0, y if key[1] else 0.0))
        return self.number[key]

    def rim(self, j):
        """Point j of 2 QUARTER + 1 on the straight edges of the square, whose corner lies at 45 degrees."""
        a, b, n = self.half, 0.8 * self.half, QUARTER
        return (a + (b - a) * j / n, b * j / n) if j <= n else (b * (2 * n - j) / n, a + (b - a) * (2 * n - j) / n)

    def at(self, r, j):
        """Point of ray j: between the rim of the square and the first radius along straight lines, beyond on circles."""
        angle = math.pi / 2 * j / (2 * QUARTER)
        x, y = math.cos(angle), math.sin(angle)
        if r > self.first - TOUCH:
            return r * x, r * y
        t = (r - self.half) / (self.first - self.half)
        u, v = self.rim(j)
        return u + t * (self.first * x - u), v + t * (self.first * y - v)

    def quad(self, radius, corners, middles=None):
        middles = middles or [[(p + q) / 2 for p, q in zip(corners[i], corners[(i + 1) % 4])] for i in range(4)]
        self.quads.append((radius, [self.add(*p) for p in (*corners, *middles)]))

    def square(self):
        n, right, corner, up = QUARTER // 2, self.rim(0), self.rim(QUARTER), self.rim(2 * QUARTER)
        top = [[(0.0, 0.0)] * (n + 1) for _ in range(n + 1)]
        for i in range(n + 1):
            for k in range(n + 1):
                s, t = i / n, k / n
                top[i][k] = tuple(s * (1 - t) * a + s * t * b + (1 - s) * t * c for a, b, c in zip(right, corner, up))
        for i in range(n):
            for k in range(n):
                self.quad(0.0, [top[i][k], top[i + 1][k], top[i + 1][k + 1], top[i][k + 1]])

    def ring(self, inner, outer):
        between, radius = (inner + outer) / 2, (inner + outer) / 2 if inner > self.first - TOUCH else 0.0
        for j in range(0, 2 * QUARTER, 2):
            at = self.at
            self.quad(radius, [at(inner, j), at(outer, j), at(outer, j + 2), at(inner, j + 2)],
                      [at(between, j), at(outer, j + 1), at(between, j + 2), at(inner, j + 1)])


def make(deck, largest, corner):
    """Mesh of a deck with bricks of at most `largest` along the axis and about `corner` at the steps [m]."""
    mesh, plane = Mesh(), Plane(deck, largest, corner)
    ends = [0.0] + [s.z + s.length for s in deck.sections]
    places = distinct(ends + [z for z, _ in deck.springs])
    steps = [s.z for a, s in zip(deck.sections, deck.sections[1:]) if sorted(a.rings) != sorted(s.rings)]
    z = graded_lines(places, lambda p: any(abs(p - step) < TOUCH for step in steps), largest, corner)
    number = {}

    def node(point, level):
        key = (point, level)
        if key not in number:
            number[key] = len(mesh.nodes)
            x, y = plane.points[point]
            height = z[level // 2] if level % 2 == 0 else (z[level // 2] + z[level // 2 + 1]) / 2
            mesh.nodes.append((x, y, height))
        return number[key]

    for i, (below, above) in enumerate(zip(z, z[1:])):
        section = next(s for s in deck.sections if (below + above) / 2 < s.z + s.length)
        for radius, points in plane.quads:
            material = next((m for inner, outer, m in section.rings if inner <= radius < outer), None)
            if material:
                bottom, top = 2 * i, 2 * i + 2
                mesh.bricks.setdefault(material, []).append(
                    [node(p, bottom) for p in points[:4]] + [node(p, top) for p in points[:4]] +
                    [node(p, bottom) for p in points[4:]] + [node(p, top) for p in points[4:]] +
                    [node(p, bottom + 1) for p in points[:4]])
    return mesh

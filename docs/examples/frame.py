# A 3-D frame of its own that Python assembles, whose modes do not fit: rotid_diagnose_model says which post has lost stiffness. The
# measured modes are made here, with noise, from the frame with a post at 60 % of its stiffness. cffi reads the header itself.
import math, random, subprocess
from cffi import FFI

def pkg_config(variable):
    return subprocess.check_output(["pkg-config", "--variable=" + variable, "rotid"], text=True).strip()

ffi = FFI()
header = ["cc", "-E", "-P", "-D__attribute__(x)=", "-D_STDDEF_H", pkg_config("includedir") + "/rotid.h"]
ffi.cdef(subprocess.check_output(header, text=True))
rotid = ffi.dlopen(pkg_config("libdir") + "/librotid.so")

# A tower of two storeys on four posts, clamped at its foot: (node, node, whether a post); nodes 0 to 3 are held
SIDE, AREA, BEND, TWIST, RHO, NU = (0.40, 0.30, 0.50), 3e-4, 3e-8, 6e-8, 7850.0, 0.3
FLOORS, POSTS, MODES = 2, 4, 6
members = [(4 * (f - 1) + p, 4 * f + p, True) for f in range(1, FLOORS + 1) for p in range(POSTS)]
members += [(4 * f + p, 4 * f + (p + 1) % POSTS, False) for f in range(1, FLOORS + 1) for p in range(POSTS)]
members += [(4 * (f - 1), 4 * f + 1, False) for f in range(1, FLOORS + 1)]
n, kd = 6 * POSTS * FLOORS, 35
masters = [6 * i + c for i in range(POSTS * FLOORS) for c in (0, 1)]  # sensors along x and y at every node

def place(node):
    return SIDE[0] * (node % 4 in (1, 2)), SIDE[1] * (node % 4 > 1), SIDE[2] * (node // 4)

def matrices_of(a, b):
    """K and M [144] of a tube from node to node for E = 1: a rod, a shaft and a beam in two planes, turned into x, y, z."""
    along = [q - p for p, q in zip(place(a), place(b))]
    length = math.hypot(*along)
    t0 = [c / length for c in along]
    t1 = [t0[2], 0, -t0[0]] if abs(t0[2]) > 0.9 else [t0[1], -t0[0], 0]
    t1 = [c / math.hypot(*t1) for c in t1]
    t = [t0, t1, [t0[(i + 1) % 3] * t1[(i + 2) % 3] - t0[(i + 2) % 3] * t1[(i + 1) % 3] for i in range(3)]]
    local = [[[0.0] * 12 for _ in range(12)] for _ in range(2)]
    for i, stiff, mass in ((0, AREA, RHO * AREA), (3, TWIST / (2 * (1 + NU)), RHO * TWIST)):
        for p, q in ((i, i), (i, i + 6), (i + 6, i), (i + 6, i + 6)):
            local[0][p][q] = stiff / length * (1 if p == q else -1)
            local[1][p][q] = mass * length / 6 * (2 if p == q else 1)
    shear, k4, m4 = 0.53 * AREA / (2 * (1 + NU)), ffi.new("double[16]"), ffi.new("double[16]")
    rotid.rotid_element_stiffness(BEND, shear, length, k4)  # of v1, theta1, v2, theta2, theta = -dv/dz
    rotid.rotid_element_mass(RHO * AREA, RHO * BEND, 12 * BEND / (shear * length**2), length, m4)
    for plane, sign in ((0, -1), (1, 1)):
        dof = ((1 + plane, 1), (5 - plane, sign), (7 + plane, 1), (11 - plane, sign))
        for i, (p, sp) in enumerate(dof):
            for j, (q, sq) in enumerate(dof):
                local[0][p][q], local[1][p][q] = sp * sq * k4[i + 4 * j], sp * sq * m4[i + 4 * j]
    turned = [[sum(t[i][p % 3] * one[3 * (p // 3) + i][3 * (q // 3) + j] * t[j][q % 3] for i in range(3) for j in range(3))
               for q in range(12) for p in range(12)] for one in local]
    return turned

unit = [matrices_of(a, b) for a, b, _ in members]
dofs = [ffi.new("int[12]", [max(6 * (end - POSTS) + c, -1) if end >= POSTS else -1 for end in (a, b) for c in range(6)]) for a, b, _ in members]
masses = [ffi.new("double[144]", m) for _, m in unit]

def add_stiffness(i, factor, k):
    return rotid.rotid_matrix_add_element(k, 12, dofs[i], ffi.new("double[144]", [factor * v for v in unit[i][0]]), ffi.NULL)

@ffi.callback("int(void *, const double *, rotid_matrix *, rotid_matrix *)")
def matrices(_, x, k, m):  # unknowns: E of the posts, E of the other members
    return max(add_stiffness(i, x[0 if post else 1], k) or rotid.rotid_matrix_add_element(m, 12, dofs[i], masses[i], ffi.NULL)
               for i, (_, _, post) in enumerate(members))

@ffi.callback("int(void *, const double *, const double *, rotid_matrix *, rotid_matrix *)")
def lose(user, x, share, k, m):  # a post without a share of its stiffness
    return add_stiffness(ffi.from_handle(user), -share[0] * x[0], k)

def measure(post, share):
    """Frequencies good to 0.05 %, shapes to 1 % of the largest component."""
    k, m = (ffi.new("rotid_matrix *", {"n": n, "kd": kd}) for _ in range(2))
    keep = [ffi.new("double[]", (kd + 1) * n) for _ in range(2)]
    k.band, m.band = keep
    x, lost, lam, phi = ffi.new("double[2]", [2.05e11, 1.9e11]), ffi.new("double *", share), ffi.new("double[]", MODES), ffi.new("double[]", n * MODES)
    if matrices(ffi.NULL, x, k, m) or lose(handles[post], x, lost, k, m) or rotid.rotid_eigenpairs(k, m, MODES, ffi.NULL, ffi.NULL, lam, phi):
        raise SystemExit("the frame has no modes")
    noise = random.Random(2)
    hz, shape = [], []
    for j in range(MODES):
        hz.append(math.sqrt(lam[j]) / (2 * math.pi) * (1 + 5e-4 * noise.gauss(0, 1)))
        at = [phi[i + n * j] for i in masters]
        shape += [v / max(map(abs, at)) + 0.01 * noise.gauss(0, 1) for v in at]
    return hz, shape

posts = [i for i, member in enumerate(members) if member[2]]
handles = [ffi.new_handle(i) for i in posts]
hz, shape = measure(5, 0.4)
names = [ffi.new("char[]", t) for t in (b"posts.E", b"others.E", b"Pa", b"post", b"share", b"1")]
moduli = ffi.new("rotid_parameter[2]", [(names[0], names[2], 1e11, 3e11, 2e11), (names[1], names[2], 1e11, 3e11, 2e11)])
lost, expected = ffi.new("rotid_parameter *", (names[4], names[5], 0, 0.95, 0.1)), ffi.new("double *", 0.3)
causes = ffi.new("rotid_host_cause[]", [{"size": ffi.sizeof("rotid_host_cause"), "name": names[3], "nparameter": 1, "parameter": lost,
                                         "deviation": expected, "add": lose, "user": handle} for handle in handles])
master = ffi.new("int[]", masters)
held = {"number": ffi.new("int[]", list(range(1, MODES + 1))), "frequency_hz": ffi.new("double[]", hz),
        "frequency_std": ffi.new("double[]", [5e-4] * MODES), "shape": ffi.new("double[]", shape), "shape_std": ffi.new("double[]", [0.01] * len(shape))}
model = ffi.new("rotid_model *", {"size": ffi.sizeof("rotid_model"), "n": n, "kd": kd, "nparam": 2, "nmaster": len(masters),
                                  "master": master, "matrices": matrices})
measured = ffi.new("rotid_measured *", {"size": ffi.sizeof("rotid_measured"), "nmode": MODES, **held})
failure, found = ffi.new("char[512]"), ffi.new("rotid_host_diagnosis **")
if rotid.rotid_diagnose_model(model, moduli, measured, len(handles), causes, ffi.NULL, ffi.NULL, failure, found) != rotid.ROTID_OK:
    raise SystemExit(ffi.string(failure).decode())
d, lead = found[0], found[0].explanation[0]
print(f"nothing {d.nothing:.3f}, something else {d.something_else:.3f}")
for c, post in enumerate(posts):
    if d.probability[c] > 0.01:
        print(f"post {members[post][0]} to {members[post][1]}: probability {d.probability[c]:.3f}")
for i in range(lead.ncause):
    print(f"its share: {lead.value[4 * i]:.3f} +- {lead.std[4 * i]:.3f}")
print(f"posts.E = {d.mean[0]:.4g}, 95 % interval {d.ci_lower[0]:.4g} ... {d.ci_upper[0]:.4g}")
rotid.rotid_host_diagnosis_free(d)

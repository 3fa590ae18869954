#include "export/ross.h"

#include <math.h>

#include "export/remark.h"
#include "export/ross_parts.h"

static const char material_function[] = "def material(name, E, G, nu, rho):\n"
                                        "    \"\"\"ROSS derives Poisson's ratio from E and G, and the shear coefficient from it; "
                                        "in the deck nu is a value of its own.\"\"\"\n"
                                        "    made = rs.Material(name, rho=rho, E=E, G_s=G)\n"
                                        "    made.Poisson = nu\n"
                                        "    return made\n"
                                        "\n"
                                        "\n";

static const char tierods_class[] =
    "class TieRods(rs.ShaftElement):\n"
    "    \"\"\"Rods coupled to the shaft at nodes n and n + span alone. The rotation of the ends stretches them (stretch, "
    "N.m/rad) and\n"
    "    moves them along the axis (ring, kg.m2).\"\"\"\n"
    "\n"
    "    def __init__(self, span, stretch, ring, **element):\n"
    "        self.span, self.stretch, self.ring = span, stretch, ring\n"
    "        super().__init__(**element)\n"
    "\n"
    "    @property\n"
    "    def dof_global_index(self):\n"
    "        return self._index\n"
    "\n"
    "    @dof_global_index.setter\n"
    "    def dof_global_index(self, index):\n"
    "        # ROSS numbers the right end as node n + 1\n"
    "        left = list(index.items())[:6] if index else []\n"
    "        right = [(f\"{name.split('_')[0]}_{self.n + self.span}\", dof + 6 * self.span) for name, dof in left]\n"
    "        self._index = dict(left + right) or None\n"
    "\n"
    "    def K(self, *args, **kwargs):\n"
    "        K = super().K(*args, **kwargs)\n"
    "        for ends in ((3, 9), (4, 10)):\n"
    "            K[np.ix_(ends, ends)] += self.stretch * np.array([[1, -1], [-1, 1]])\n"
    "        return K\n"
    "\n"
    "    def M(self, *args, **kwargs):\n"
    "        M = super().M(*args, **kwargs)\n"
    "        for ends in ((3, 9), (4, 10)):\n"
    "            M[np.ix_(ends, ends)] += self.ring / 6 * np.array([[2, 1], [1, 2]])\n"
    "        return M\n"
    "\n"
    "    def G(self, *args, **kwargs):\n"
    "        G = super().G(*args, **kwargs)\n"
    "        polar = self.ring / 3 * np.array([[2, 1], [1, 2]])\n"
    "        G[np.ix_((3, 9), (4, 10))] += polar\n"
    "        G[np.ix_((4, 10), (3, 9))] -= polar\n"
    "        return G\n"
    "\n"
    "\n";

static const char spring_class[] =
    "class RotationalSpring(rs.DiskElement):\n"
    "    \"\"\"A spring to ground on the rotation of a node [N.m/rad], which bearings of ROSS do not have.\"\"\"\n"
    "\n"
    "    def __init__(self, n, stiffness, tag):\n"
    "        self.stiffness = stiffness\n"
    "        super().__init__(n=n, m=0.0, Id=0.0, Ip=0.0, tag=tag)\n"
    "\n"
    "    def K(self, *args, **kwargs):\n"
    "        return np.diag([0.0, 0.0, 0.0, self.stiffness, self.stiffness, 0.0])\n"
    "\n"
    "\n";

static const char matrices_class[] =
    "class GivenElement(rs.ShaftElement):\n"
    "    \"\"\"An element whose bending matrices are those of MATRICES, the same in both planes.\"\"\"\n"
    "\n"
    "    XZ, YZ = (0, 4, 6, 10), (1, 3, 7, 9)\n"
    "    SIGN = np.diag([1.0, -1.0, 1.0, -1.0])  # alpha = -dy/dz\n"
    "\n"
    "    def __init__(self, given, **element):\n"
    "        super().__init__(**element)\n"
    "        self.given = {name: np.array(given[name]) for name in (\"stiffness\", \"mass\", \"rotary\")}\n"
    "        self.m += given[\"added\"]\n"
    "\n"
    "    def __eq__(self, other):\n"
    "        return self is other\n"
    "\n"
    "    __hash__ = rs.ShaftElement.__hash__\n"
    "\n"
    "    def planes(self, matrix, given):\n"
    "        matrix[np.ix_(self.XZ, self.XZ)] = given\n"
    "        matrix[np.ix_(self.YZ, self.YZ)] = self.SIGN @ given @ self.SIGN\n"
    "        return matrix\n"
    "\n"
    "    def K(self, *args, **kwargs):\n"
    "        return self.planes(super().K(*args, **kwargs), self.given[\"stiffness\"])\n"
    "\n"
    "    def M(self, *args, **kwargs):\n"
    "        return self.planes(super().M(*args, **kwargs), self.given[\"mass\"])\n"
    "\n"
    "    def G(self, *args, **kwargs):\n"
    "        G = np.zeros((12, 12))\n"
    "        G[np.ix_(self.XZ, self.YZ)] = 2 * self.given[\"rotary\"] @ self.SIGN\n"
    "        return G - G.T\n"
    "\n"
    "\n";

static const char frequency_functions[] =
    "def bending_hz(rotor, count, above):\n"
    "    \"\"\"The lowest bending frequencies above a frequency [Hz] at rest, by the symmetric matrices of the measured "
    "plane.\"\"\"\n"
    "    plane = np.sort(np.r_[0:rotor.ndof:6, 4:rotor.ndof:6])\n"
    "    K, M = rotor.K(0)[np.ix_(plane, plane)], rotor.M()[np.ix_(plane, plane)]\n"
    "    shift = (2 * np.pi * above) ** 2\n"
    "    mu = eigh(M, K + shift * M, eigvals_only=True)[::-1]  # rounding is relative to the lowest frequencies then\n"
    "    hz = np.sqrt(np.maximum(1 / mu[mu > 0] - shift, 0)) / (2 * np.pi)\n"
    "    return hz[hz > above][:count]\n"
    "\n"
    "\n"
    "def modal_hz(rotor, count, above):\n"
    "    \"\"\"The same by run_modal, whose unsymmetric problem has the rounding of the highest frequencies: the two planes of a "
    "mode differ\n"
    "    by it, and their mean is returned. Axial and torsional modes are left out.\"\"\"\n"
    "    modal = rotor.run_modal(speed=0, num_modes=min(4 * count + 16, rotor.ndof - 2))\n"
    "    size = [np.abs(modal.modes[i::6]).max(axis=0) for i in range(6)]\n"
    "    lateral = np.maximum.reduce([size[0], size[1], size[3], size[4]]) > np.maximum(size[2], size[5])\n"
    "    hz = np.sort(modal.evalues.imag[lateral]) / (2 * np.pi)\n"
    "    hz = hz[hz > above]\n"
    "    pairs = np.split(hz, np.flatnonzero(np.diff(hz) > 1e-3 * hz[1:]) + 1)\n"
    "    return np.array([pair.mean() for pair in pairs[:count] if pair.size] + count * [np.nan])[:count]\n"
    "\n"
    "\n";

static void put_head(FILE *stream, const struct ross_model *ross)
{
    struct remark remark = {stream, "# ", 120};
    (void)fputs("#!/usr/bin/env python3\n", stream);
    remark_put(&remark,
               "For ROSS, package ross-rotordynamics: `from FILE import build` gives the rotor, running the file its modes.");
    remark_model(&remark, ross->model);
    remark_put(&remark, "%s", "");
    remark_put(&remark,
               "Bending is that of rotid: x along the measured plane, beta = dx/dz = -theta. What was not measured is what "
               "ROSS makes of diameters and materials: axial and torsional motion; there is no damping. Gyroscopic moments "
               "are those of round sections. Keep the script, not a rotor that ROSS has saved: Poisson's ratio and the "
               "classes below do not survive that.");
    (void)fputs("import numpy as np\nimport ross as rs\nfrom scipy.linalg import eigh\n\n", stream);
}

static void put_list(FILE *stream, const char *name, int count, const double *value)
{
    char number[32];
    (void)fprintf(stream, "%s = [", name);
    for (int i = 0; i < count; i++)
        (void)fprintf(stream, "%s%s", i ? ", " : "", isfinite(value[i]) ? remark_number(value[i], number) : "float(\"nan\")");
    (void)fputs("]\n", stream);
}

static void put_frequencies(FILE *stream, const struct ross_model *ross)
{
    const struct spectrum *s = ross->spectrum;
    double rigid = s->nrigid ? s->rigid_hz[s->nrigid - 1] : 0;
    char number[32];
    (void)fputs("# What rotid computes for this rotor [Hz], and the middle between them and motion on the supports.\n", stream);
    put_list(stream, "BENDING_HZ", s->count, s->full_hz);
    (void)fprintf(stream, "LOWEST_HZ = %s\n", remark_number(s->count ? (rigid + s->full_hz[0]) / 2 : rigid, number));
    if (ross->deck_hz) {
        (void)fputs("# The same modes of the deck's own model, with what this script leaves out.\n", stream);
        put_list(stream, "DECK_HZ", s->count, ross->deck_hz);
    }
    (void)fputs("\n\n", stream);
}

static void put_build(FILE *stream, const struct ross_needs *needs)
{
    (void)fputs(
        "\n\ndef build():\n"
        "    \"\"\"The rotor.\"\"\"\n"
        "    def section(L, outer, inner, name, force):\n"
        "        return {\"L\": L, \"idl\": inner, \"odl\": outer, \"material\": MATERIAL[name], \"axial_force\": force}\n\n",
        stream);
    (void)fputs("    shaft = [rs.ShaftElement(n=n, **section(*row)) for n, row in enumerate(SHAFT)]\n", stream);
    if (needs->matrices)
        (void)fputs("    for n, given in MATRICES.items():\n"
                    "        shaft[n] = GivenElement(given, n=n, **section(*SHAFT[n]))\n",
                    stream);
    if (needs->tierods)
        (void)fputs("    for first, last, *row, stretch, ring in TIERODS:\n"
                    "        shaft.append(TieRods(last - first, stretch, ring, n=first, **section(*row)))\n",
                    stream);
    (void)fputs("    return rs.Rotor(shaft, DISKS, SPRINGS)\n\n\n", stream);
}

static void put_main(FILE *stream, const struct ross_model *ross)
{
    int deck = ross->deck_hz != NULL;
    (void)fprintf(stream,
                  "if __name__ == \"__main__\":\n"
                  "    ROTOR = build()\n"
                  "    EXACT = bending_hz(ROTOR, len(BENDING_HZ), LOWEST_HZ)\n"
                  "    MODAL = modal_hz(ROTOR, len(BENDING_HZ), LOWEST_HZ)\n"
                  "    print(\"mode     rotid [Hz]  matrices of ROSS [Hz]  difference      run_modal [Hz]  difference%s\")\n"
                  "    for i, hz in enumerate(BENDING_HZ):\n"
                  "        print(f\"{i + 1:4d} {hz:14.6f} {EXACT[i]:22.6f} {EXACT[i] / hz - 1:11.1e}\", end=\"\")\n"
                  "        print(f\" {MODAL[i]:19.6f} {MODAL[i] / hz - 1:11.1e}%s\")\n",
                  deck ? "       deck [Hz]" : "", deck ? " {DECK_HZ[i]:15.6f}" : "");
}

int ross_write(struct pool *pool, FILE *stream, const struct ross_model *ross)
{
    struct ross_needs needs = ross_needs(ross);
    put_head(stream, ross);
    put_frequencies(stream, ross);
    (void)fputs(material_function, stream);
    if (needs.tierods)
        (void)fputs(tierods_class, stream);
    if (needs.rotational_springs)
        (void)fputs(spring_class, stream);
    if (needs.matrices)
        (void)fputs(matrices_class, stream);
    (void)fputs(frequency_functions, stream);
    int status = ross_put_shaft(pool, stream, ross);
    if (!status && needs.matrices)
        status = ross_put_matrices(pool, stream, ross);
    if (!status)
        status = ross_put_attached(pool, stream, ross);
    if (status)
        return status;
    put_build(stream, &needs);
    put_main(stream, ross);
    return ROTID_OK;
}

"""CalculiX: its input from a mesh of one quarter, its run, its frequencies."""
import os
import shutil
import subprocess
from pathlib import Path

PROGRAM = shutil.which("ccx")


def rows(values, a_row):
    """Lines of at most `a_row` values, each but the last ending in a comma."""
    parts = [", ".join(str(value) for value in values[i:i + a_row]) for i in range(0, len(values), a_row)]
    return [part + "," for part in parts[:-1]] + parts[-1:]


def spring_nodes(mesh, z):
    """The node on the axis; where the section is hollow, all of its nodes, which share the spring."""
    numbers = [i for i, node in enumerate(mesh.nodes, 1) if abs(node[2] - z) < 1e-9]
    on_axis = [i for i in numbers if mesh.nodes[i - 1][:2] == (0, 0)]
    return on_axis or numbers


def text_of(deck, mesh, frequencies):
    """Bending in the plane y = 0: there v = 0; across it, at x = 0, u is even, v and w are odd. Besides the first circumferential
    harmonic this leaves the third, the fifth ..., whose modes lie far above. A quarter carries a quarter of each spring, whose
    stiffness needs a decimal point: ccx takes a line without one for a degree of freedom."""
    out = ["*NODE"] + [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(mesh.nodes, 1)]
    count = 0
    for body, (material, bricks) in enumerate(mesh.bricks.items(), 1):
        out.append(f"*ELEMENT, TYPE=C3D20R, ELSET=BODY{body}")
        for brick in bricks:
            count += 1
            out += rows([count] + [n + 1 for n in brick], 12)
        m = deck.materials[material]
        axial = m.axial_nu * m.plane_e / m.axial_e  # contraction along the axis by stress in the plane
        plane_g = m.plane_e / (2 * (1 + m.plane_nu))
        constants = [m.plane_e, m.plane_e, m.axial_e, m.plane_nu, axial, axial, plane_g, m.axial_g, m.axial_g]
        out += [f"*MATERIAL, NAME=BODY{body}", "*ELASTIC, TYPE=ENGINEERING CONSTANTS", *rows([f"{c:.12e}" for c in constants], 8),
                "*DENSITY", f"{m.rho:.12e}", f"*SOLID SECTION, ELSET=BODY{body}, MATERIAL=BODY{body}"]
    for k, (z, stiffness) in enumerate(deck.springs, 1):
        nodes = spring_nodes(mesh, z)
        out.append(f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{k}")
        out += [f"{count + i}, {node}" for i, node in enumerate(nodes, 1)]
        out += [f"*SPRING, ELSET=SPRING{k}", "1", f"{stiffness / 4 / len(nodes):.12e}"]
        count += len(nodes)
    out += ["*BOUNDARY"]
    out += [f"{i}, 2, 2" for i, (x, y, _) in enumerate(mesh.nodes, 1) if x == 0 or y == 0]
    out += [f"{i}, 3, 3" for i, (x, _, _) in enumerate(mesh.nodes, 1) if x == 0]
    out += ["*STEP", "*FREQUENCY", f"{frequencies}", "*END STEP", ""]
    return "\n".join(out)


def frequencies_of(path):
    """Hz, of the first table of a .dat file: number, eigenvalue, rad/s, Hz, imaginary part."""
    found = []
    for line in path.read_text().splitlines():
        fields = line.split()
        if "P A R T I C I P A T I O N" in line:
            break
        if len(fields) == 5 and fields[0].isdigit():
            found.append(float(fields[3]))
    return found


def run(deck, mesh, modes, folder):
    """The first elastic bending frequencies [Hz]; two more, below, move the rotor on its springs. One thread, at low priority."""
    count = modes + 2
    folder = Path(folder)
    (folder / "job.inp").write_text(text_of(deck, mesh, count))
    one = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER"), "1")
    command = ["nice", "-n", "19", PROGRAM, "-i", "job"]
    done = subprocess.run(command, cwd=folder, env={**os.environ, **one}, capture_output=True, text=True)
    data = folder / "job.dat"
    found = frequencies_of(data) if data.exists() else []
    if done.returncode or len(found) < count:
        raise RuntimeError(f"ccx: exit code {done.returncode}, {len(found)} of {count} frequencies\n{done.stdout[-2000:]}")
    return found[2:count]

"""Universal files beside pyuff. Every file of the data folder of pyuff's source distribution, then sets of every kind that pyuff wrote:
rotid uff lists the sets and values that pyuff reads, or refuses a set for a reason that holds. The conversion that docs/uff.md shows."""
import contextlib
import io
import re
import subprocess
import sys
import tarfile
import warnings
from pathlib import Path

import jsonschema
import numpy as np
import pyuff

from support import ROOT, Checks, parse, rotid, temporary_folder

VERSION = "2.4.2"
# files that hold no universal set, or one that is broken, and what rotid says of it
REFUSED = {
    "meas_point_1.txt": "no universal file",
    "meas_point_2.txt": "no universal file",
    "meas_point_3.txt": "no universal file",
    "dataset_milestone_in_header.uff": "record 7 announces 2508876 values",  # cut off by its author
}


def data_folder():
    """The unpacked source distribution beside the program; 78 MB that are downloaded once."""
    build = Path(sys.argv[1]).resolve().parent
    folder = build / f"pyuff-{VERSION}"
    if not folder.is_dir():
        subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--disable-pip-version-check", "--no-binary", ":all:", "--no-deps",
                        "--no-build-isolation", "-d", build, f"pyuff=={VERSION}"], check=True)
        with tarfile.open(build / f"pyuff-{VERSION}.tar.gz") as archive:
            archive.extractall(build, filter="data")
    return folder / "data"


SCHEMA = jsonschema.Draft202012Validator(parse((ROOT / "docs" / "schema" / "uff.schema.json").read_text()))


def listing(path):
    code, out, err = rotid("uff", path, "--verbose", "--json", "-")
    return code, parse(out) if out else None, err


def read(path):
    """The sets as pyuff has them, None for those that it cannot read."""
    file = pyuff.UFF(str(path))
    sets = []
    for i in range(file.get_n_sets()):
        try:
            with contextlib.redirect_stdout(io.StringIO()):  # pyuff prints what it reads of some sets
                sets.append(file.read_sets(i))
        except Exception:  # whatever it is: pyuff raises bare exceptions
            sets.append(None)
    return [int(t) for t in file.get_set_types()], sets


def near(seen, expected, tolerance):
    seen, expected = np.atleast_1d(seen), np.atleast_1d(expected)
    return seen.shape == expected.shape and bool(np.all(abs(seen - expected) <= tolerance * np.maximum(abs(expected), 1e-300)))


def moments(function):
    """What the listing says of the values, from pyuff's. A sum is as good as the sum of moduli."""
    data = np.asarray(function["data"])
    scale = abs(data).sum()
    return {"first": data[0], "last": data[-1], "sum": data.sum(), "rms": np.sqrt((abs(data) ** 2).mean())}, scale


def same_function(seen, function):
    """An empty text, or what differs."""
    data = np.asarray(function["data"])
    if seen["count"] != data.size:
        return f"{seen['count']} values for {data.size}"
    expected, scale = moments(function)
    for key in ("first", "last", "sum"):
        value = complex(*seen[key])
        if abs(value - expected[key]) > 1e-12 * (scale if key == "sum" else abs(expected[key])):
            return f"{key} {value} for {expected[key]}"
    if not near(seen["rms"], expected["rms"], 1e-10):
        return f"rms {seen['rms']} for {expected['rms']}"
    keys = {"type": "func_type", "response_node": "rsp_node", "response_direction": "rsp_dir", "reference_node": "ref_node",
            "reference_direction": "ref_dir", "ordinate": "ord_data_type"}
    for key, theirs in keys.items():
        if seen[key] != function[theirs]:
            return f"{key} {seen[key]} for {function[theirs]}"
    x = np.asarray(function["x"])
    if not near([seen["start"], seen["end"]], x[[0, -1]], 1e-9):
        return f"abscissa {seen['start']} to {seen['end']} for {x[0]} to {x[-1]}"
    return ""


def same_shape(seen, shape):
    parts = [shape[f"r{c}"] for c in range(1, 7) if f"r{c}" in shape]
    values = np.array(parts).T.ravel()
    if seen["nodes"] != [int(n) for n in shape["node_nums"]]:
        return "other nodes"
    real, imag = np.array(seen["real"]), np.array(seen["imag"]) if seen["imag"] else 0
    return "" if near(real + 1j * imag, values + 0j, 1e-12) else "other values"


def of_type(types, sets, *numbers):
    return [s for t, s in zip(types, sets) if t in numbers]


def check_listing(checks, path, meant=None):
    name = path.name
    code, seen, err = listing(path)
    if name in REFUSED:
        place = f"{path}:" in err and REFUSED[name] in err
        checks.true(f"{name}: refused with place and reason", code in (1, 2) and place, (code, err[:200]))
        return
    if not checks.true(f"{name}: listed", code == 0, (code, err[:300])):
        return
    wrong = [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in SCHEMA.iter_errors(seen)]
    checks.true(f"{name}: the JSON follows its schema", not wrong, wrong[:3])
    types, sets = read(path)
    sets = meant or sets
    checks.true(f"{name}: the same {len(types)} sets", [s["set"] for s in seen["sets"]] == types, [s["set"] for s in seen["sets"]][:20])
    unread = sum(s is None for s in sets)
    functions = of_type(types, sets, 58)
    if functions:
        wrong = [f"{i + 1}: {w}" for i, (a, b) in enumerate(zip(seen["functions"], functions)) if b and (w := same_function(a, b))]
        checks.true(f"{name}: {len(functions)} functions", len(functions) == len(seen["functions"]) and not wrong, wrong[:3])
    nodes = [s for s in of_type(types, sets, 15, 781, 2411) if s]
    if nodes:
        ids = np.concatenate([np.asarray(s["node_nums"]) for s in nodes]).astype(int)
        x = np.concatenate([np.column_stack((s["x"], s["y"], s["z"])) for s in nodes])
        checks.true(f"{name}: {ids.size} nodes", seen["nodes"]["ids"] == list(ids) and near(seen["nodes"]["x"], x, 1e-12), seen["nodes"]["count"])
    shapes = of_type(types, sets, 55)
    if shapes:
        wrong = [f"{i + 1}: {w}" for i, (a, b) in enumerate(zip(seen["shapes"], shapes)) if b and (w := same_shape(a, b))]
        checks.true(f"{name}: {len(shapes)} shapes", len(shapes) == len(seen["shapes"]) and not wrong, wrong[:3])
    over = {s["set"] for s in seen["sets"] if s["state"] == "read_over"}
    checks.true(f"{name}: what is read over", over == set(types) & {18, 82, 2412, 2414, 2420}, over)
    if unread:
        print(f"   {name}: pyuff cannot read {unread} of its {len(sets)} sets")


RANDOM = np.random.default_rng(11)
# an even number, for of an odd one pyuff cannot write the last line when its abscissa is uneven
PAIR = RANDOM.standard_normal(38) + 1j * RANDOM.standard_normal(38)
LABELS = {"id1": "a function", "rsp_node": 19, "rsp_dir": -1, "ref_node": 1, "ref_dir": 3, "abscissa_spec_data_type": 18,
          "abscissa_axis_lab": "Frequency", "abscissa_axis_units_lab": "Hz", "ordinate_spec_data_type": 12, "ordinate_axis_units_lab": "m/s2",
          "orddenom_spec_data_type": 13, "orddenom_axis_units_lab": "N", "z_axis_value": 0.0}


def function(complex_, even, binary):
    x = 0.25 + 0.125 * np.arange(38) if even else np.cumsum(0.125 * RANDOM.integers(1, 9, 38))
    return {"type": 58, **LABELS, "binary": int(binary), "func_type": 4 if complex_ else 1, "x": x, "data": PAIR if complex_ else PAIR.real,
            "abscissa_spacing": int(even), "ord_data_type": 6 if complex_ else 4}


def written_by_pyuff():
    """Name and sets."""
    nodes = {"node_nums": np.array([1, 2, 30]), "def_cs": np.array([0, 1, 2]), "disp_cs": np.array([0, 0, 1]), "color": np.array([8, 8, 7]),
             "x": np.array([0.0, 0.125, 1.5]), "y": np.array([0.0, -1.25, 3.5]), "z": np.array([1e-3, 0.5, -2.0])}
    shape = {"model_type": 1, "data_ch": 2, "spec_data_type": 8, "load_case": 1, "mode_n": 3, "node_nums": [1, 2, 30],
             "r1": np.array([1.0, -0.5, 0.25]), "r2": np.array([0.0, 2.0, 3e-5]), "r3": np.array([0.5, 0.25, -1e-7])}
    turned = {k: v * (1 + 0.5j) if k in ("r1", "r2", "r3") else v for k, v in shape.items()}
    point = {"x": np.array([1 + 2j, 3 - 1j]), "y": np.array([0.5j, 1 + 0j]), "z": np.array([2e-9 + 1j, -1 + 0j])}
    yield "15", [{"type": 15, **nodes}]
    yield "2411", [{"type": 2411, **nodes}]
    yield "82", [pyuff.prepare_82(trace_num=2, n_nodes=4, color=30, id="shaft", nodes=np.array([1, 2, 0, 30]))]
    yield "151", [pyuff.prepare_151(model_name="rotor", description="test", db_app="bench", version_db1=1, version_db2=2, file_type=0,
                                    date_db_created="27-Jan-16", time_db_created="14:38:15", date_db_saved="28-Jan-16",
                                    time_db_saved="14:38:16", program="bench")]
    yield "164", [pyuff.prepare_164(units_code=1, units_description="SI units", temp_mode=1, length=3.28083989501312334,
                                    force=0.224808943099710480, temp=1.8, temp_offset=459.67)]
    yield "55 normal mode", [{"type": 55, "analysis_type": 2, "freq": 72.125, "modal_m": 1.5, "modal_damp_vis": 0.01, "modal_damp_his": 0.0, **shape}]
    six = {f"r{c}": np.array([1.0, 2.0, 3.0]) * c for c in range(1, 7)}
    yield "55 normal mode, rotations", [{"type": 55, "analysis_type": 2, "freq": 72.125, **{**shape, **six, "data_ch": 3}}]
    for analysis in (3, 7):
        yield f"55 complex, analysis {analysis}", [{"type": 55, "analysis_type": analysis, "eig": -4.5 + 453.25j, "modal_a": 1 + 2j,
                                                    "modal_b": 3 - 4j, **turned}]
    yield "55 frequency response", [{"type": 55, "analysis_type": 5, "freq": 100.0, "freq_step_n": 7, **turned}]
    beam = {"element_nums": 1, "fe_descriptor": 11, "phys_table": 1, "mat_table": 2, "color": 7, "num_nodes": 2, "beam_orientation": 0,
            "beam_foreend_cross": 1, "beam_aftend_cross": 1, "nodes_nums": [1, 2]}
    quad = {"element_nums": 2, "fe_descriptor": 44, "phys_table": 2, "mat_table": 1, "color": 2, "num_nodes": 4, "nodes_nums": [1, 2, 30, 4]}
    yield "2412", [{"type": 2412, 11: [beam], 44: [quad]}]
    yield "2414", [pyuff.prepare_2414(analysis_dataset_label=1, analysis_dataset_name="displacement", dataset_location=1, id1="bench", id2="x",
                                      id3="x", id4="x", id5="x", model_type=0, analysis_type=5, data_characteristic=2, result_type=8, data_type=5,
                                      number_of_data_values_for_the_data_component=3, design_set_id=1, iteration_number=0, solution_set_id=1,
                                      boundary_condition=0, load_set=1, mode_number=0, time_step_number=0, frequency_number=4, creation_option=1,
                                      number_retained=1, time=0.0, frequency=100.0, eigenvalue=100.0, modal_mass=0.0, viscous_damping=0.0,
                                      hysteretic_damping=0.0, real_part_eigenvalue=0.0, imaginary_part_eigenvalue=0.0,
                                      real_part_of_modal_A_or_modal_mass=0.0, imaginary_part_of_modal_A_or_modal_mass=0.0,
                                      real_part_of_modal_B_or_modal_mass=0.0, imaginary_part_of_modal_B_or_modal_mass=0.0,
                                      node_nums=np.array([29, 30]), **point)]
    yield "2420", [pyuff.prepare_2420(Part_UID=1, Part_Name="rotor", CS_sys_labels=[1], CS_types=[0], CS_colors=[8], CS_names=["CS1"],
                                      CS_matrices=[np.vstack((np.eye(3), [0.5, 0.0, 1.0]))])]
    for complex_ in (0, 1):
        for even in (0, 1):
            yield (f"58 {'complex' if complex_ else 'real'} {'even' if even else 'uneven'}", [function(complex_, even, 0)])
            # pyuff announces too few bytes for complex and for uneven functions, but writes them all
            yield (f"58b {'complex' if complex_ else 'real'} {'even' if even else 'uneven'}", [function(complex_, even, 1)])


def check_written(checks, name, sets, folder):
    source = Path(folder) / f"pyuff {name}.uff"
    file = pyuff.UFF(str(source))
    for one in sets:
        file._write_set(one, "add")
    check_listing(checks, source, sets if name == "15" else None)  # of which pyuff loses the last line when it reads what it wrote


def check_recipe(checks, folder):
    """The two lines of docs/uff.md, from text to binary and back."""
    block = re.search(r"```python\n(import pyuff\n.*?)```", (ROOT / "docs" / "uff.md").read_text(), re.S)[1]
    text, binary, back = (Path(folder) / name for name in ("text.uff", "binary.uff", "back.uff"))
    text.write_bytes((ROOT / "tests" / "data" / "uff" / "beam_excerpt.uff").read_bytes())
    for script in (block, block.replace('"binary.uff"', '"back.uff"').replace('"text.uff"', '"binary.uff"').replace('"binary": 1', '"binary": 0')):
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", script], cwd=folder, capture_output=True, text=True)
        checks.true("docs/uff.md: the conversion by pyuff runs", done.returncode == 0, done.stderr[-300:])
    first, second, third = (listing(path)[1] for path in (text, binary, back))
    checks.true("docs/uff.md: binary and text again", [s["binary"] for s in second["sets"]] == [True] * 3 and [s["binary"] for s in third["sets"]] == [False] * 3, "")
    for other in (second, third):
        same = all(near(a[key], b[key], 1e-10) for a, b in zip(first["functions"], other["functions"]) for key in ("first", "last", "rms", "count"))
        checks.true("docs/uff.md: with the same values", same and len(other["functions"]) == 3, "")


def main():
    checks = Checks()
    warnings.simplefilter("ignore", ResourceWarning)  # files that pyuff leaves open
    with temporary_folder() as folder:
        for name, sets in written_by_pyuff():
            check_written(checks, name, sets, folder)
        for path in sorted(data_folder().iterdir()):
            check_listing(checks, path)
        check_recipe(checks, folder)
    checks.end()


if __name__ == "__main__":
    main()

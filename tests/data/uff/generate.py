"""Writes the universal files of this directory with pyuff (https://github.com/ladisk/pyuff); the values test_uff.c expects.
pyuff 2.5.8: python -m venv v && v/bin/pip install pyuff && v/bin/python generate.py"""

import os

import numpy as np
import pyuff

TOOL = "pyuff " + pyuff.__version__
NODES = [1, 2, 3, 5, 8, 13]


def write(name, sets):
    if os.path.exists(name):
        os.remove(name)
    pyuff.UFF(name).write_sets(sets, mode="overwrite")


def value(mode, node, component):
    """What the test computes too; the 6 digits of a set 55 hold it without loss."""
    return (-1) ** node * (mode * 1000 + node * 10 + component) / 1000


def shape(mode, component):
    return np.array([value(mode, node, component) for node in NODES])


def header(analysis, data_type, components, mode):
    return dict(type=55, id1=TOOL, id2="NONE", id3="NONE", id4="NONE", id5="NONE", model_type=1, analysis_type=analysis,
                data_ch=2 if components == 3 else 3, spec_data_type=8, data_type=data_type, n_data_per_node=components,
                load_case=1, mode_n=mode, node_nums=NODES)


n = len(NODES)
title = dict(type=151, model_name=TOOL, description="test", db_app="rotid", program="rotid",
             date_db_created="01-Jan-26", time_db_created="00:00:00", date_db_saved="01-Jan-26",
             time_db_saved="00:00:00", date_file_written="01-Jan-26", time_file_written="00:00:00")
nodes_15 = pyuff.prepare_15(node_nums=NODES, def_cs=[0] * n, disp_cs=[0] * n, color=[8] * n,
                            x=[-1.0 - k for k in range(n)], y=[0.5 * k for k in range(n)], z=[-1e-3 * k for k in range(n)])
nodes_2411 = dict(type=2411, node_nums=np.array(NODES), def_cs=np.zeros(n), disp_cs=np.zeros(n), color=np.full(n, 8),
                  x=np.array([-1.0] * n), y=np.array([k / 3 for k in range(n)]), z=np.array([-np.pi * k for k in range(n)]))


def normal(mode, components):
    return dict(header(2, 2, components, mode), freq=100.25 * mode, modal_m=1.0, modal_damp_vis=0.01 * mode, modal_damp_his=0.0,
                **{f"r{c + 1}": shape(mode, c) for c in range(components)})


def damped(mode, analysis):
    return dict(header(analysis, 5, 3, mode), eig=-3.0 * mode + 400j * mode, modal_a=1 + 2j, modal_b=3 - 4j,
                **{f"r{c + 1}": shape(mode, c) - 2j * shape(mode, c) for c in range(3)})


write("real_modes.uff", [title, nodes_15, normal(1, 3), normal(2, 3), normal(3, 6)])
write("complex_modes.uff", [damped(1, 3), damped(2, 7)])
write("nodes_2411.uff", [title, nodes_2411])

"""Writes the two netCDF-4 Exodus files of the tests of pericles-mesh.

    python validation/formats/make_netcdf4.py crates/pericles-mesh/tests/files

Needs meshio, netCDF4 and numpy. Both hold the mesh of tests/formats/files.rs, a cube beside a wedge: meshio.exo as meshio writes it (64-bit numbers, no names of blocks, no side sets),
compressed.exo with all sets, as programs write it that use the Exodus library (32-bit numbers, deflate and shuffle, a time step with the nodal variable Volume).
"""

import pathlib
import sys

import meshio
import netCDF4
import numpy as np

folder = pathlib.Path(sys.argv[1])
nodes = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [2, 0, 0], [2, 0, 1]],
    float,
)
cube, wedge = [0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 2, 5, 9, 6]

mesh = meshio.Mesh(nodes, [("hexahedron", [cube]), ("wedge", [wedge])], point_sets={"tip": np.array([9])})
meshio.write(folder / "meshio.exo", mesh, file_format="exodus")

lengths = {"time_step": None, "num_dim": 3, "num_nodes": 10, "one": 1, "eight": 8, "six": 6, "two": 2, "len_name": 16}
lengths |= {"num_el_blk": 3, "num_node_sets": 1, "num_side_sets": 1, "num_elem_sets": 1}


def characters(*words):
    return np.array([list(word.ljust(16, "\0")) for word in words], "S1")


variables = {
    "coordx": (["num_nodes"], nodes[:, 0]),
    "coordy": (["num_nodes"], nodes[:, 1]),
    "coordz": (["num_nodes"], nodes[:, 2]),
    "eb_prop1": (["num_el_blk"], np.array([10, 20, 30], "i4")),
    "eb_names": (["num_el_blk", "len_name"], characters("left part", "nothing", "right")),
    "connect1": (["one", "eight"], np.array([cube], "i4") + 1),
    "connect3": (["one", "six"], np.array([wedge], "i4") + 1),
    "ns_names": (["num_node_sets", "len_name"], characters("tip")),
    "node_ns1": (["one"], np.array([10], "i4")),
    "ss_names": (["num_side_sets", "len_name"], characters("x0")),
    "elem_ss1": (["one"], np.array([1], "i4")),
    "side_ss1": (["one"], np.array([4], "i4")),
    "els_prop1": (["num_elem_sets"], np.array([3], "i4")),
    "elem_els1": (["two"], np.array([1, 2], "i4")),
    "vals_nod_var1": (["time_step", "num_nodes"], np.ones((2, 10))),
}
with netCDF4.Dataset(folder / "compressed.exo", "w", format="NETCDF4") as file:
    for name, length in lengths.items():
        file.createDimension(name, length)
    for name, (dimensions, values) in variables.items():
        variable = file.createVariable(name, values.dtype, dimensions, zlib=True, shuffle=True)
        variable.set_auto_mask(False)
        variable[:] = values
    file["connect1"].elem_type = "HEX8"
    file["connect3"].elem_type = "wedge"

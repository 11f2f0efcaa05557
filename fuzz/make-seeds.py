#!/usr/bin/env python3
"""Writes fuzz/seeds: small valid files of every format that Pericles reads. The files are in the repository; run this script only to change them."""

import base64
import json
import pathlib
import struct
import zlib

SEEDS = pathlib.Path(__file__).parent / "seeds"
X = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
T = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]


def write(target, name, content):
    folder = SEEDS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def lines(rows):
    return "".join(" ".join(map(str, row)) + "\n" for row in rows)


def obj():
    vertices = lines(("v", *x) for x in X)
    write("obj", "plain", vertices + lines(("f", *(v + 1 for v in t)) for t in T))
    corner = lambda v: f"{v - 4}/{v + 1}/{v + 1}"
    write("obj", "corners", "# by hand\n" + vertices + lines(("f", *map(corner, t)) for t in T))
    write("obj", "quad", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1 # back\n")


def off():
    body = lines(X) + lines((3, *t) for t in T)
    write("off", "plain", "OFF\n4 4 6\n" + body)
    write("off", "comment", "COFF # colours\n4 4 0\n" + lines((*x, 255, 0, 0) for x in X) + lines((3, *t) for t in T))


def ply():
    header = "ply\nformat {} 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\n" \
             "element face 4\nproperty list uchar int vertex_indices\nelement other 1\nproperty list uchar short s\nend_header\n"
    write("ply", "ascii", header.format("ascii") + lines((*x, 7) for x in X) + lines((3, *t) for t in T) + "2 4 5\n")
    for order, name in [("<", "binary_little_endian"), (">", "binary_big_endian")]:
        data = b"".join(struct.pack(order + "fdfB", *x, 7) for x in X)
        data += b"".join(struct.pack(order + "Biii", 3, *t) for t in T) + struct.pack(order + "Bhh", 2, 4, 5)
        write("ply", name, header.format(name).encode() + data)


def stl():
    facet = lambda t: "facet normal 0 0 1\nouter loop\n" + lines(("vertex", *X[v]) for v in t) + "endloop\nendfacet\n"
    write("stl", "ascii", "solid a\n" + "".join(map(facet, T)) + "endsolid a\n")
    triangle = lambda t: bytes(12) + b"".join(struct.pack("<fff", *X[v]) for v in t) + bytes(2)
    write("stl", "binary", b"solid".ljust(80) + struct.pack("<I", 4) + b"".join(map(triangle, T)))


def gmsh():
    head = "$MeshFormat\n{} {} 8\n"
    nodes = lines((k + 1, *x) for k, x in enumerate(X))
    elements = lines((k + 1, 2, 2, 0, 1, *(v + 1 for v in t)) for k, t in enumerate(T))
    write("gmsh", "2-ascii", head.format("2.2", 0) + "$EndMeshFormat\n$Nodes\n4\n" + nodes + "$EndNodes\n$Elements\n5\n9 15 2 0 1 1\n" + elements + "$EndElements\n")
    one = struct.pack("<i", 1)
    binary = head.format("2.2", 1).encode() + one + b"\n$EndMeshFormat\n$Nodes\n4\n"
    binary += b"".join(struct.pack("<iddd", k + 1, *x) for k, x in enumerate(X)) + b"\n$EndNodes\n$Elements\n4\n"
    binary += struct.pack("<iii", 2, 4, 2) + b"".join(struct.pack("<iiiiii", k + 1, 0, 1, *(v + 1 for v in t)) for k, t in enumerate(T))
    write("gmsh", "2-binary", binary + b"\n$EndElements\n")
    write("gmsh", "4-ascii", head.format("4.1", 0) + "$EndMeshFormat\n$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n" + lines(X) +
          "$EndNodes\n$Elements\n1 4 1 4\n2 1 2 4\n" + lines((k + 1, *(v + 1 for v in t)) for k, t in enumerate(T)) + "$EndElements\n")
    binary = head.format("4.1", 1).encode() + one + b"\n$EndMeshFormat\n$Nodes\n" + struct.pack("<4Q", 1, 4, 1, 4) + struct.pack("<iiiQ", 2, 1, 0, 4)
    binary += struct.pack("<4Q", 1, 2, 3, 4) + b"".join(struct.pack("<ddd", *x) for x in X) + b"\n$EndNodes\n$Elements\n"
    binary += struct.pack("<4Q", 1, 4, 1, 4) + struct.pack("<iiiQ", 2, 1, 2, 4)
    binary += b"".join(struct.pack("<4Q", k + 1, *(v + 1 for v in t)) for k, t in enumerate(T))
    write("gmsh", "4-binary", binary + b"\n$EndElements\n")


def abaqus():
    nodes = "*NODE, NSET=N\n" + "".join(f"{k + 1}, " + ", ".join(map(str, x)) + "\n" for k, x in enumerate(X))
    tet = "*ELEMENT, TYPE=C3D4, ELSET=E\n1, 1, 2, 3, 4\n"
    write("abaqus", "flat", "*HEADING\n" + nodes + tet + "*ELSET, ELSET=G, GENERATE\n1, 9, 2\n*SURFACE, NAME=S\nE, S2\n*SURFACE, NAME=F\nE,\n*STEP\n")
    write("abaqus", "instances", "*PART, NAME=P\n" + nodes + tet + "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1, 0, 0\n0, 0, 0, 0, 0, 1, 90\n"
          "*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n*END INSTANCE\n*NSET, NSET=M\nI.N, J.N\n*ELSET, ELSET=O, INSTANCE=J\n1\n*END ASSEMBLY\n")


def exodus():
    text = lambda word: struct.pack(">I", len(word)) + word.encode() + bytes(-len(word) % 4)
    dimensions = [("nodes", 4), ("elements", 1), ("num_el_blk", 1), ("num_node_sets", 1), ("num_side_sets", 1)]
    variables = [(f"coord{axis}", [0], 6, struct.pack(">4d", *(x[c] for x in X)), None) for c, axis in enumerate("xyz")]
    variables += [("connect1", [1, 0], 4, struct.pack(">4i", 1, 2, 3, 4), "TETRA"), ("eb_prop1", [2], 4, struct.pack(">i", 1), None),
                  ("node_ns1", [3], 4, struct.pack(">i", 2), None), ("elem_ss1", [4], 4, struct.pack(">i", 1), None), ("side_ss1", [4], 4, struct.pack(">i", 3), None)]
    for version in (1, 2):
        def header(begin):
            out = b"CDF" + bytes([version]) + struct.pack(">III", 0, 10, len(dimensions))
            out += b"".join(text(name) + struct.pack(">I", length) for name, length in dimensions) + struct.pack(">IIII", 0, 0, 11, len(variables))
            for name, own, kind, data, attribute in variables:
                out += text(name) + struct.pack(f">I{len(own)}I", len(own), *own)
                out += struct.pack(">II", 12, 1) + text("elem_type") + struct.pack(">I", 2) + text(attribute) if attribute else struct.pack(">II", 0, 0)
                out += struct.pack(">IIQ" if version == 2 else ">III", kind, len(data), begin)
                begin += len(data)
            return out
        write("exodus", f"cdf-{version}", header(len(header(0))) + b"".join(data for _, _, _, data, _ in variables))


def vtk_arrays(kind):
    """Arrays as (name, type, components, numbers)."""
    flat = lambda rows: [v for row in rows for v in row]
    cells = [("connectivity", "Int64", 1, flat(T)), ("offsets", "Int64", 1, [3, 6, 9, 12])]
    if kind == "vtu":
        cells.append(("types", "UInt8", 1, [5] * 4))
    return [("Points", [("Points", "Float64", 3, flat(X))]), ("PointData", [("Damage", "Float32", 1, [0, 0.5, 1, 0])]), ("Cells" if kind == "vtu" else "Polys", cells)]


PACK = {"Float64": "d", "Float32": "f", "Int64": "q", "UInt8": "B"}


def vtk(kind):
    grid = "UnstructuredGrid" if kind == "vtu" else "PolyData"
    sizes = 'NumberOfPoints="4" NumberOfCells="4"' if kind == "vtu" else 'NumberOfPoints="4" NumberOfPolys="4"'
    for form in ["ascii", "binary", "packed", "raw"]:
        appended, sections = b"", ""
        for section, arrays in vtk_arrays(kind):
            sections += f"<{section}>"
            for name, scalar, components, numbers in arrays:
                data = struct.pack(f"<{len(numbers)}{PACK[scalar]}", *numbers)
                sections += f'<DataArray type="{scalar}" Name="{name}" NumberOfComponents="{components}" '
                if form == "ascii":
                    sections += f'format="ascii">{" ".join(map(str, numbers))}</DataArray>'
                elif form == "binary":
                    sections += f'format="binary">{base64.b64encode(struct.pack("<I", len(data)) + data).decode()}</DataArray>'
                elif form == "packed":
                    packed = zlib.compress(data)
                    table = struct.pack("<4I", 1, len(data), 0, len(packed))
                    sections += f'format="binary">{base64.b64encode(table).decode()}{base64.b64encode(packed).decode()}</DataArray>'
                else:
                    sections += f'format="appended" offset="{len(appended)}"/>'
                    appended += struct.pack("<I", len(data)) + data
            sections += f"</{section}>"
        packer = ' compressor="vtkZLibDataCompressor"' if form == "packed" else ""
        text = f'<VTKFile type="{grid}" byte_order="LittleEndian"{packer}><{grid}><Piece {sizes}>{sections}</Piece></{grid}>'
        tail = b'<AppendedData encoding="raw">_' + appended + b"</AppendedData>" if form == "raw" else b""
        write(kind, form, text.encode() + tail + b"</VTKFile>")


def points():
    rows = [(0, 0, 0, 1, 1e-9), (0.5, 0, 0, 1, 1e-9), (0, 0.5, 0, 2, 1e-9)]
    write("points", "plain", b"\x02" + lines(rows).encode())
    write("points", "header", b"\x01header: x y block_id volume\n" + lines((x, y, b, v) for x, y, _, b, v in rows).encode())
    write("points", "commas", b"\x00# a bar\nx, block, volume\n0, 1, 1\n1.5, 1, 1 ! the end\n")


def outline():
    write("outline", "frame", "# a frame\n0 0\n4, 0\n4 3\n0 3 # last\n0 0\n\n1 1\n2 1\n2 2\n")
    write("outline", "windows", "\ufeff0 0\r\n1e-3 0\r\n1e-3 2.5E-3\r\n")
    write("outline", "crossed", "0 0\n1 1\n1 0\n0 1\n")


def checkpoint():
    entry = {"name": "u", "type": "u8", "len": 4, "stored": 0, "crc32": 0, "codec": "shuffle+lz4"}
    # An LZ4 frame with uncompressed data: header, one block marked as uncompressed, end mark.
    frame = bytes.fromhex("04224d18604082") + struct.pack("<I", 4 | 1 << 31) + b"abcd" + bytes(4)
    header = {"metadata": {"step": 1}, "sections": [dict(entry, stored=len(frame)), dict(entry, name="v", stored=len(frame))]}
    write("checkpoint", "two", json.dumps(header, separators=(",", ":")).encode() + b"\n" + frame + frame)
    write("checkpoint", "none", '{"metadata":null,"sections":[]}\n')
    # Version 2: a block as it is, and one in the block format of LZ4: a literal, fourteen repetitions of it, five literals.
    entry = {"name": "u", "type": "u8", "len": 4, "codec": "shuffle+lz4"}
    header = {"metadata": {"step": 1}, "sections": [entry, dict(entry, name="v", len=20)]}
    packed = bytes.fromhex("1a61010050") + b"bcdef"
    write("checkpoint", "blocks", json.dumps(header, separators=(",", ":")).encode() + f"\n4 {len(packed)}\nabcd".encode() + packed)


BAR = """body = { shape = "bar", length = 12, spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 2, MATERIAL }
initial = [{ velocity = [{ expression = "0.01*exp(-4*(x-6)^2)" }] }]
time = { end = 2, dt = 0.1, SCHEME }
MORE"""

PLATE = """body = { shape = "plate", size = [6, 4], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 2, critical_stretch = 0.05, MATERIAL }
crack = [{ segment = [[0, 2], [2, 2]] }]
sets.left = { layer = { side = "-x", cells = 2 } }
sets.top = { layer = { side = "+y", cells = 1 } }
sets.bottom = { layer = { side = "-y", cells = 1 } }
constraint = [{ set = "top", velocity = ["free", 0.1] }, { set = "bottom", velocity = ["free", -0.1] }]
time = { end = 2, dt = 0.1, SCHEME }
"""

SURFACE = """body = { shape = "icosphere", level = 1, radius = 1 }
material = { density = 1, alpha = 0.25, p = 2, horizon = 0.9, critical_stretch = 0.02 }
initial = [{ random_velocity = { radius = 0.1, seed = 1 } }]
time = { end = 1, dt = 0.01, SCHEME }
"""

ENDS = """boundary = [{ kind = "absorbing", side = "-x", HISTORY }, { kind = "absorbing", side = "+x", HISTORY }]
"""

# One deck for every scheme, operator and boundary with state.
MODELS = {
    "list-verlet": (PLATE, 'bonds = "list"', 'scheme = "velocity-verlet"', ""),
    "grid-rk4": (PLATE, 'bonds = "grid"', 'scheme = "rk4"', ""),
    "list-rk4-mts": (PLATE, 'bonds = "list"', 'scheme = "multirate-rk4", ratio = 2, adaptive = { every = 2, layers = 1 }', ""),
    "grid-rk3-mts": (PLATE, 'bonds = "grid"', 'scheme = "multirate-rk3", ratio = 3, fine = ["left"]', ""),
    "list-respa": (PLATE, 'bonds = "list"', 'scheme = "respa", ratio = 2, adaptive = { every = 1, layers = 1 }', ""),
    "list-anderson": (PLATE, 'bonds = "list"', 'scheme = "newmark", solver = "anderson"', ""),
    "dormand-prince": (BAR, 'model = "linear"', 'scheme = "dormand-prince"', ""),
    "midpoint": (BAR, 'model = "linear"', 'scheme = "implicit-midpoint", linear_solver = "direct"', ""),
    "trigonometric": (BAR, 'model = "linear"', 'scheme = "trigonometric"', ""),
    "discrete-gradient": (BAR, 'model = "bond-stretch"', 'scheme = "discrete-gradient"', ""),
    "ends-direct": (BAR, 'model = "linear"', 'scheme = "velocity-verlet"', ENDS.replace("HISTORY", 'history = "direct"')),
    "ends-blocked": (BAR, 'model = "linear"', 'scheme = "velocity-verlet"', ENDS.replace("HISTORY", 'history = "blocked"')),
    "ends-exponentials": (BAR, 'model = "linear"', 'scheme = "velocity-verlet"', ENDS.replace("HISTORY", 'history = "exponentials", tolerance = 1e-4')),
    "surface-rk4": (SURFACE, "", 'scheme = "rk4"', ""),
    "surface-respa": (SURFACE, "", 'scheme = "respa", ratio = 2, adaptive = { every = 1 }', ""),
}


def models():
    for name, (text, material, scheme, more) in MODELS.items():
        text = text.replace("MATERIAL", material).replace("SCHEME", scheme).replace("MORE", more)
        write("model", name + ".toml", text)


def texts():
    expressions = ["1e-3 * exp(-(x/0.01)^2)", "sin(2*pi*x) + t^2/(1+t)", "x > 0 && (y < 1 || block == 2)", "-x^2^0.5*step(t-1)", "0 < x <= 1", "!(x == 3)"]
    # The first byte selects the place of an expression.
    for k, text in enumerate(expressions):
        write("expression", f"{k}", ("0" if set("<>=") & set(text) else str(1 + k % 2)) + text)
    for k, text in enumerate(["72 GPa", "0.25 mm", "135 J/m2", "kg/m3", "2440 kg·m^-3", "1e-3 N/m²", "5 %", "90 min", "1/s", "-.5e-3 µs"]):
        write("quantity", f"{k}", text)
    # The first byte selects a deck or a modification.
    for target in ["resume", "cache"]:
        for k in range(len(MODELS)):
            write(target, f"{k}", bytes([k]) + bytes(range(1, 20)))


for make in [obj, off, ply, stl, gmsh, abaqus, exodus, points, outline, checkpoint, models, texts]:
    make()
for kind in ["vtu", "vtp"]:
    vtk(kind)

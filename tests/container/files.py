"""Files with everything in them, and how to take them apart and lie about them."""

import numpy as np
import xxhash

import ebz
from ebz.codec.elements import Element
from ebz.codec.sample import glued_grid
from tests import surgery
from tests.data.golden import seam

START = 9  # bytes of magic and version
Chunks = list[tuple[bytes, bytes]]

HEADER_FIELDS = [
    *("itemsize", "n_vertices", "n_symbols", "n_closed", "n_single", "n_specials"),
    *("n_copies", "n_exceptions", "face_size", "model", "method", "lattice"),
]
POLYGON_FIELDS = ["n_polygons", "n_empty", "n_polygon_corners"]  # behind face_size, if it is 1
BYTES = {"itemsize", "face_size", "model", "method", "lattice"}


def rich_mesh() -> ebz.Mesh:
    """Two components, a handle, holes, gluing, isolated vertices, attributes and metadata."""
    torus = glued_grid(3, 4, "join", "join")[2]
    annulus = glued_grid(1, 4, "open", "join")[2]
    tetrahedron = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])
    pages = np.array([(0, 1, 2), (0, 1, 3), (1, 0, 4)])
    faces = surgery.union([torus, annulus, tetrahedron, pages, np.array([(0, 1, 2)])])
    n = surgery.n_used(faces) + 2
    vertices = np.arange(3 * n, dtype=np.float32).reshape(-1, 3) ** 2 % 97 / 8
    vertices[3, 1] = np.nan
    return ebz.Mesh(
        vertices,
        faces,
        {
            "red": np.arange(n, dtype=np.uint8),
            "uv": np.arange(2 * n, dtype=np.uint16).reshape(n, 2),
        },
        {"corner": faces.astype(np.int16), "label": np.arange(len(faces), dtype=np.int16) % 5},
        {"format": "ply", "raw": b"\0\xff", "n": [1, None, 2.5]},
        corner_attributes={"s": (faces % 5).reshape(-1) / 4},
        elements={
            "edge": Element(np.arange(0, 13, 2), np.arange(12) * 5 % n, {"w": np.arange(6)}),
            "line": Element(np.array([0, 3, 3, 5]), np.arange(5), {}, {"t": np.arange(5) / 8}),
            "camera": Element(np.zeros(2, int), attributes={"matrix": np.eye(4)[None]}),
        },
    )


def finite_mesh() -> ebz.Mesh:
    mesh = rich_mesh()
    return ebz.Mesh(np.nan_to_num(mesh.vertices), mesh.faces)


def polygons() -> ebz.Mesh:
    """A triangle, a quad, a pentagon and an empty face."""
    corners = [0, 1, 2, 0, 2, 3, 4, 2, 1, 5, 6, 7]
    return ebz.Mesh(np.eye(8, 3), corners, face_offsets=[0, 3, 7, 12, 12])


def files() -> dict[str, bytes]:
    """Between them they have every kind of chunk and of lattice."""
    plain, finite = rich_mesh(), finite_mesh()
    triangle = ebz.Mesh(np.eye(3), [[0, 1, 2]])
    random = finite.vertices + np.float32(0.1) ** np.arange(3, dtype=np.float32)
    return {
        "everything": ebz.compress(plain),
        "fast": ebz.compress(plain, level=1),
        "table": ebz.compress(finite, model="stack"),
        "polygons": ebz.compress(polygons()),
        "box": ebz.compress(finite, bits=7),
        "step": ebz.compress(finite, max_error=0.01),
        "grid": ebz.compress(finite, grid=((1, 2, 3), 0.01)),
        "float": ebz.compress(ebz.Mesh(np.sqrt(random.astype(float)), finite.faces)),
        "single": ebz.compress(ebz.Mesh(np.sqrt(random).astype(float), finite.faces)),
        "listed": ebz.compress(ebz.Mesh(np.sqrt(np.arange(18) % 5).reshape(6, 3), [[0, 1, 2]] * 6)),
        "automaton": ebz.compress(triangle, model="loop-60", embed_model=True),
        "stack": ebz.compress(triangle, model="stack", embed_model=True),
        "order": ebz.compress(plain, keep_order=True),
        "seam": ebz.compress(seam()),
        "empty": ebz.compress(ebz.Mesh([], [])),
    }


def varint(value: int) -> bytes:
    sevens = []
    while value > 127:
        sevens.append(value & 127 | 128)
        value >>= 7
    return bytes([*sevens, value])


def read_varint(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte, at = data[at], at + 1
        value, shift = value | (byte & 127) << shift, shift + 7
        if byte < 128:
            return value, at


def split(data: bytes) -> Chunks:
    """Types and payloads of the chunks."""
    chunks, at = [], START
    while at < len(data):
        length, body = read_varint(data, at + 1)
        chunks.append((data[at : at + 1], data[body : body + length]))
        at = body + length + 4
    return chunks


def join(chunks: Chunks) -> bytes:
    """The file, its checksums right."""
    data = b"\x89EBZ\r\n\x1a\n\x02"
    for kind, payload in chunks:
        body = kind + varint(len(payload)) + payload
        data += body + checksum(body)
    return data


def checksum(body: bytes) -> bytes:
    """What follows the type, length and payload of a chunk."""
    return xxhash.xxh3_64_digest(body)[:3:-1]


def offset(chunks: Chunks, index: int) -> int:
    """Where in the file a chunk begins."""
    return len(join(chunks[:index]))


def with_payload(data: bytes, kind: bytes, payload: bytes) -> bytes:
    """The file with another payload in the first chunk of that kind."""
    chunks = split(data)
    index = [other for other, _ in chunks].index(kind)
    chunks[index] = (kind, payload)
    return join(chunks)


def read_header(data: bytes) -> tuple[dict[str, int], bytes]:
    """The fields, and the bytes of the lattice's parameters."""
    payload, at, fields = split(data)[0][1], 0, {}
    for name in HEADER_FIELDS:
        fields[name], at = (payload[at], at + 1) if name in BYTES else read_varint(payload, at)
        if name == "face_size" and fields[name] == 1:
            for counted in POLYGON_FIELDS:
                fields[counted], at = read_varint(payload, at)
    return fields, payload[at:]


def with_header(data: bytes, **changes: int) -> bytes:
    fields, parameters = read_header(data)
    fields |= changes
    coded = [bytes([fields[n]]) if n in BYTES else varint(fields[n]) for n in fields]
    return with_payload(data, b"H", b"".join(coded) + parameters)


def attribute(
    name: bytes, kind: bytes, itemsize: int, shape: list[int], data: bytes, seams_size: int = 0
) -> bytes:
    """The payload of an attribute chunk, its head as it is."""
    head = varint(1) + varint(len(name)) + name + kind + bytes([itemsize, len(shape)])
    plan = bytes([0, 0, 0, 0, 0, 0])  # exact numbers without guess, relation, specials, labels
    head += b"".join(map(varint, shape)) + plan + varint(seams_size)
    return 2 * varint(len(head)) + head + data

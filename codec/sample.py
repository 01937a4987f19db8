"""Meshes made from nothing: uniform random triangulations, and smooth shapes of any size.

Every mesh is a function of its arguments alone, on every machine and for ever: the random bits are
PCG64's raw stream, which numpy promises not to change, and coordinates need only IEEE + - * / sqrt.
"""

import math

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError
from ebz.codec.mesh import Mesh

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

ICOSAHEDRON = """0b5 051 017 07a 0ab 159 5b4 ba2 a76 718
                 394 342 326 368 389 495 24b 62a 867 981"""  # vertices in hexadecimal
GOLDEN_TURN = (math.sqrt(5) - 1) / 2


def random_triangulation(n_vertices: int, seed: int = 0) -> Mesh:
    """A uniform random rooted simple triangulation of the sphere, in linear time.

    Every rooted triangulation with `n_vertices` >= 3 vertices is exactly equally likely; there are
    1, 1, 3, 13, 68, 399, ... of them.  The root is the directed edge from the last vertex but one
    to the last.  Vertices lie in that order on a spiral around the unit sphere, float32: the
    positions are distinct but know nothing of the connectivity.  Three vertices give one triangle
    seen from both sides.

    Raises OptionError where `n_vertices` < 3 or `seed` < 0.
    Source: D. Poulalhon and G. Schaeffer, "Optimal coding and sampling of triangulations", 2006.
    """
    if n_vertices < 3:
        raise OptionError(f"{n_vertices} vertices: a triangulation of the sphere has at least 3")
    bits = _random_bits(seed)
    word = _uniform_word(bits, n_vertices - 2)
    rotation, root = bits.random_raw(2) >> np.uint64(63)
    faces = close_word(word, int(rotation), int(root))
    return Mesh(spiral(n_vertices).astype(np.float32), faces)


def close_word(word: npt.NDArray[np.bool_], rotation: int, root: int) -> Indices:
    """The faces, (2 n, 3), of the triangulation that closes the blossoming tree of a word.

    word: 4 n - 2 letters with n - 1 ones: a tree of n nodes with two stems each, read around it
    from a stem; a one goes down a new edge, a node's first two zeros are its stems, its third goes
    back up.  `rotation` (0 or 1) selects which of the word's two rotations that are trees is meant,
    `root` (0 or 1) the direction of the root edge.  All words and choices together give every
    rooted triangulation with n + 2 vertices equally often.
    """
    heights = np.cumsum(np.where(word, 3, -1))
    # Cycle lemma: from where a sum of -2 first reaches its minimum, or one above, and from nowhere
    # else, the rotated word stays above -2 until its last letter.
    start = int(np.argmax(heights == heights.min() + rotation)) + 1
    n_nodes = (len(word) + 2) // 4
    boundary, faces = _partial_closure(np.roll(word, -start).tolist())
    apexes = (n_nodes, n_nodes + 1) if root else (n_nodes + 1, n_nodes)
    faces += _outer_faces(boundary, apexes)
    return np.array(faces, np.int64).reshape(-1, 3)


def _uniform_word(bits: np.random.PCG64, n_nodes: int) -> npt.NDArray[np.bool_]:
    length, n_ones = 4 * n_nodes - 2, n_nodes - 1
    while True:
        keys = bits.random_raw(length)
        word: npt.NDArray[np.bool_] = keys < np.partition(keys, n_ones)[n_ones]
        # Equal keys at the threshold are drawn anew: whether there are any does not depend on the
        # order of the keys, so every word stays equally likely.
        if np.count_nonzero(word) == n_ones:
            return word


def _partial_closure(word: list[bool]) -> tuple[list[int], list[int]]:
    """The outer boundary and the faces that arise inside.

    The boundary is a cyclic list of v (an edge arrives at vertex v) and ~v (a stem leaves v).
    """
    boundary = [0, 0]  # two edges that no stem precedes, so that index -2 always exists
    faces: list[int] = []
    n_nodes, node = 1, 0
    path, zeros_left = [0], [3]  # the root keeps its third zero: both of its zeros are stems

    def arrive(at: int) -> None:
        # A stem followed by two edges is bent to the end of the second and becomes an edge itself.
        while boundary[-1] >= 0 > boundary[-2]:
            middle = boundary.pop()
            start = ~boundary.pop()
            faces.extend((start, middle, at))
        boundary.append(at)

    for is_edge in word:
        if is_edge:
            node = n_nodes
            n_nodes += 1
            path.append(node)
            zeros_left.append(3)
            arrive(node)
        elif zeros_left[-1] > 1:
            zeros_left[-1] -= 1
            boundary.append(~node)
        else:
            path.pop()
            zeros_left.pop()
            node = path[-1]
            arrive(node)
    first_stem = next(i for i in range(2, len(boundary)) if boundary[i] < 0)
    for at in boundary[2:first_stem]:
        arrive(at)
    return boundary[first_stem:], faces


def _outer_faces(boundary: list[int], apexes: tuple[int, int]) -> list[int]:
    """The faces at the two last vertices, which take the stems that are left.

    There are two more stems than edges and at most two stems at a corner, so exactly two corners
    have two; between these all stems go to the same apex.
    """
    faces: list[int] = []
    apex, other = apexes
    stem = ~boundary[0]
    arrived = -1
    for letter in boundary[1:] + boundary[:1]:
        if letter >= 0:
            arrived = letter
        elif arrived >= 0:
            faces += (stem, arrived, apex)
            stem, arrived = arrived, -1
        else:
            faces += (apex, stem, other)
            apex, other = other, apex
    return faces


def sphere(n_triangles: int, noise: float = 0.0, seed: int = 0) -> Mesh:
    """A unit sphere of about `n_triangles` (20 k^2): an icosahedron, each face cut into k^2."""
    _check_size(n_triangles)
    corners, triangles = icosahedron()
    vertices, faces = subdivide(corners, triangles, max(1, round(math.sqrt(n_triangles / 20))))
    x, y, z = vertices.T
    return _noisy(vertices / np.sqrt(x * x + y * y + z * z)[:, None], faces, noise, seed)


def torus(n_triangles: int, noise: float = 0.0, seed: int = 0) -> Mesh:
    """A torus of about `n_triangles` (4 k^2, k >= 3) with radii 1 and 0.4."""
    _check_size(n_triangles)
    n_around = max(3, round(math.sqrt(n_triangles / 4)))
    row, column, faces = glued_grid(n_around, 2 * n_around, "join", "join")
    cos_u, sin_u = circle(column / (2 * n_around))
    cos_v, sin_v = circle(row / n_around)
    radius = 1 + 0.4 * cos_v
    vertices = np.stack([radius * cos_u, radius * sin_u, 0.4 * sin_v], axis=1)
    return _noisy(vertices, faces, noise, seed)


def grid(n_triangles: int, noise: float = 0.0, seed: int = 0) -> Mesh:
    """A hilly terrain of about `n_triangles` (2 k^2) over the unit square."""
    _check_size(n_triangles)
    n_cells = max(1, round(math.sqrt(n_triangles / 2)))
    row, column, faces = glued_grid(n_cells, n_cells, "open", "open")
    x, y = column / n_cells, row / n_cells
    height = 0.08 * circle(1.3 * x + 0.4 * y)[1]
    height += 0.05 * circle(2.1 * y - 0.9 * x)[0] + 0.02 * circle(4.7 * x)[1] * circle(5.3 * y)[1]
    return _noisy(np.stack([x, y, height], axis=1), faces, noise, seed)


def glued_grid(
    n_rows: int, n_columns: int, rows: str, columns: str
) -> tuple[Indices, Indices, Indices]:
    """Row and column of every vertex, and the faces, (m, 3), of a grid glued to itself.

    Every one of the n_rows n_columns cells becomes two triangles.  `rows` says how the last row of
    vertices meets the first ("open" or "join"), `columns` the same for columns ("open", "join", or
    "twist": with rows reversed).
    """
    i, j = np.divmod(np.arange((n_rows + 1) * (n_columns + 1)), n_columns + 1)
    if columns != "open":
        seam = j == n_columns
        i = np.where(seam & (columns == "twist"), n_rows - i, i)
        j = np.where(seam, 0, j)
    if rows == "join":
        i = np.where(i == n_rows, 0, i)
    keys, index = np.unique(i * (n_columns + 1) + j, return_inverse=True)
    row, column = np.divmod(keys, n_columns + 1)
    index = index.reshape(n_rows + 1, -1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return row, column, np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


def icosahedron() -> tuple[Floats, Indices]:
    """Vertices (12, 3), of equal but not of unit length, and faces (20, 3)."""
    golden = 1 + GOLDEN_TURN
    rectangle = np.array([[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0]])
    vertices = np.concatenate([np.roll(rectangle, axis, axis=1) for axis in range(3)])
    faces = [[int(corner, 16) for corner in face] for face in ICOSAHEDRON.split()]
    return vertices, np.array(faces, np.int64)


def subdivide(vertices: Floats, faces: Indices, k: int) -> tuple[Floats, Indices]:
    """Every face cut into k^2 by points that cut its edges into k; vertices on edges are shared.

    The given vertices come first, then k - 1 along every edge, then those inside of faces.
    """
    i, j = np.nonzero(np.add.outer(np.arange(k + 1), np.arange(k + 1)) <= k)
    weights = np.stack([k - i - j, i, j])
    ends = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    edges, edge = np.unique(ends, axis=0, return_inverse=True)
    low, high = edges.T
    n_vertices, n_edges = len(vertices), len(low)
    inside = (weights > 0).all(axis=0)
    n_inside = int(np.count_nonzero(inside))

    first_inside = n_vertices + n_edges * (k - 1)
    index = np.empty((len(faces), len(i)), np.int64)
    number = np.arange(len(faces) * n_inside).reshape(len(faces), n_inside)
    index[:, inside] = first_inside + number
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        index[:, weights[a] == k] = faces[:, [a]]
        on_edge = (weights[c] == 0) & (weights[a] > 0) & (weights[b] > 0)
        from_low = np.where(faces[:, [a]] < faces[:, [b]], weights[b][on_edge], weights[a][on_edge])
        index[:, on_edge] = n_vertices + edge.reshape(-1, 3)[:, [a]] * (k - 1) + from_low - 1

    steps = np.arange(1, k)[None, :, None]
    on_edges = (vertices[low][:, None] * (k - steps) + vertices[high][:, None] * steps) / k
    corners = vertices[faces][:, :, None]
    w = weights[:, None, inside, None]
    in_faces = (corners[:, 0] * w[0] + corners[:, 1] * w[1] + corners[:, 2] * w[2]) / k
    points = np.concatenate([vertices, on_edges.reshape(-1, 3), in_faces.reshape(-1, 3)])
    return points, index[:, _lattice_faces(k, i, j)].reshape(-1, 3)


def spiral(n: int) -> Floats:
    """Points, (n, 3), evenly spread over the unit sphere from pole to pole."""
    at = np.arange(n, dtype=np.float64) + 0.5
    z = 1 - 2 * at / n
    radius = np.sqrt(1 - z * z)
    cos, sin = circle(at * GOLDEN_TURN)
    return np.stack([radius * cos, radius * sin, z], axis=1)


def circle(turns: npt.NDArray[np.float64]) -> tuple[Floats, Floats]:
    """Cosine and sine of angles in turns, within 4e-16, the same bits on every machine.

    Exact at multiples of a quarter turn; libraries' sines differ in their last bits.
    """
    quarters = np.rint(4 * turns)
    angle = (turns - quarters / 4) * math.tau  # at most pi / 4: the next terms are below 2^-55
    square = angle * angle
    cos, sin = np.zeros_like(angle), np.zeros_like(angle)
    for n in range(8, -1, -1):
        cos = cos * square + (-1) ** n / math.factorial(2 * n)
        sin = sin * square + (-1) ** n / math.factorial(2 * n + 1)
    sin = sin * angle
    quadrant = quarters.astype(np.int64) & 3
    x = np.choose(quadrant, [cos, -sin, -cos, sin]) + 0.0  # + 0.0 turns -0.0 into 0.0
    y = np.choose(quadrant, [sin, cos, -sin, -cos]) + 0.0
    return x, y


def uniform(seed: int, shape: tuple[int, ...]) -> Floats:
    """Random numbers in [0, 1), multiples of 2^-53."""
    words = _random_bits(seed).random_raw(math.prod(shape)) >> np.uint64(11)
    return words.astype(np.float64).reshape(shape) * 2.0**-53


def _lattice_faces(k: int, i: Indices, j: Indices) -> Indices:
    number = np.zeros((k + 2, k + 2), np.int64)
    number[i, j] = np.arange(len(i))
    up, down = i + j < k, i + j < k - 1
    a, b = i[up], j[up]
    c, d = i[down], j[down]
    pointing_up = np.stack([number[a, b], number[a + 1, b], number[a, b + 1]], axis=1)
    pointing_down = np.stack([number[c + 1, d], number[c + 1, d + 1], number[c, d + 1]], axis=1)
    return np.concatenate([pointing_up, pointing_down])


def _random_bits(seed: int) -> np.random.PCG64:
    if seed < 0:
        raise OptionError(f"seed {seed}: must not be negative")
    return np.random.PCG64(seed)


def _check_size(n_triangles: int) -> None:
    if n_triangles < 1:
        raise OptionError(f"{n_triangles} triangles: must be at least 1")


def _noisy(vertices: Floats, faces: Indices, noise: float, seed: int) -> Mesh:
    """As float32, every coordinate moved by at most `noise`."""
    if not 0 <= noise < math.inf:
        raise OptionError(f"noise {noise}: must be finite and not negative")
    if noise:
        vertices = vertices + noise * (2 * uniform(seed, vertices.shape) - 1)
    return Mesh(vertices.astype(np.float32), faces)

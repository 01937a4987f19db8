"""What the tests of the command line share: the environment, results and two meshes."""

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

BIN = Path(sys.executable).parent
TETRAHEDRON = b"""\
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
"""


@dataclass(frozen=True)
class Result:
    """What a shell sees of a finished command."""

    status: int
    stdout: bytes
    stderr: bytes


Shell = Callable[..., Result]


def environment() -> dict[str, str]:
    """Few variables, so that the outcome does not depend on who runs the tests."""
    path = os.pathsep.join((str(BIN), "/usr/bin", "/bin"))
    return {"PATH": path, "LC_ALL": "C.UTF-8", "TERM": "dumb", "TZ": "UTC"}


def grid(n: int) -> bytes:
    """A bumpy height field of n x n vertices as ASCII PLY, n <= 400."""
    rows = [f"{x} {y} {(x * x + 3 * y * y) % 17}" for y in range(n) for x in range(n)]
    faces = []
    for y in range(n - 1):
        for x in range(n - 1):
            a = y * n + x
            faces += [f"3 {a} {a + 1} {a + n}", f"3 {a + 1} {a + n + 1} {a + n}"]
    header = TETRAHEDRON.split(b"0 0 0\n")[0].decode()
    header = header.replace("vertex 4", f"vertex {len(rows)}")
    header = header.replace("face 4", f"face {len(faces)}")
    return (header + "\n".join([*rows, *faces]) + "\n").encode()

"""Which mesh format a file has: by its first bytes, else by its name."""

from pathlib import PurePath

from ebz.codec.errors import MeshError
from ebz.formats.ply.reader import is_ply

SUFFIXES = {
    "ply": ".ply",
    "obj": ".obj",
    "off": ".off",
    "stl": ".stl",
    "gltf": ".gltf",
    "glb": ".glb",
}
FORMATS = tuple(SUFFIXES)
GLB_MAGIC = b"glTF"
HEAD_SIZE = 4096
OBJ_KEYWORDS = frozenset(
    b"v vt vn vp f l p g o s mtllib usemtl call cstype deg curv surf parm".split()
)


def suffix_of(format: str) -> str:
    """The suffix of files of `format`, dot included."""
    return SUFFIXES[format]


def format_of_suffix(suffix: str) -> str | None:
    """The format of files with `suffix` (".ply"), None where it is no mesh format."""
    return next((name for name, known in SUFFIXES.items() if known == suffix.lower()), None)


def format_of(data: bytes, name: str | None = None) -> str:
    """The format of a mesh file, by content, else by the suffix of `name`.

    Raises MeshError where neither tells.
    """
    found = format_of_content(data)
    if found is None and name is not None:
        found = format_of_suffix(PurePath(name).suffix)
    if found is None:
        what = "the data is empty" if not data else "the format cannot be recognised"
        raise MeshError(f"{what}: name it with --from ({', '.join(FORMATS)})")
    return found


def format_of_content(data: bytes) -> str | None:
    """The format that the content shows, None where it shows none.

    A binary STL may begin with "solid", like an ascii one, but its size follows from its count.
    """
    head = bytes(data[:HEAD_SIZE])
    if is_ply(head):
        return "ply"
    if head.startswith(GLB_MAGIC):
        return "glb"
    if is_binary_stl(data):
        return "stl"
    return _format_of_text(head.removeprefix(b"\xef\xbb\xbf"))


def is_binary_stl(data: bytes) -> bool:
    """Whether the size of the data is the one that its count of facets asks for."""
    return len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")


def _format_of_text(head: bytes) -> str | None:
    for line in head.splitlines():
        words = line.split(b"#")[0].split()
        if not words:
            continue
        if words[0].lower() == b"solid":
            return "stl"
        if words[0].removesuffix(b"OFF") in OFF_PREFIXES and words[0].endswith(b"OFF"):
            return "off"
        if words[0] in OBJ_KEYWORDS:
            return "obj"
        if head.lstrip().startswith(b"{") and b'"asset"' in head:
            return "gltf"
        return None
    return None


OFF_PREFIXES = frozenset(
    st + c + n + four + dim
    for st in (b"", b"ST")
    for c in (b"", b"C")
    for n in (b"", b"N")
    for four in (b"", b"4")
    for dim in (b"", b"n")
)

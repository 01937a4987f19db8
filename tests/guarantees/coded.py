"""What the word of a mesh takes, coded by the kernels, beside what the certificate grants it."""

import os
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import ebz
from ebz.codec import connectivity
from ebz.codec.models.certificate import Certificate
from ebz.codec.models.load import AnyTable
from ebz.codec.models.table import SYMBOLS
from ebz.codec.word import EncodedWord

Faces = npt.NDArray[np.integer[Any]]

ROOT = Path(__file__).resolve().parents[2]
DATA = Path(os.environ.get("EBZ_TEST_DATA", ROOT.parent / "shared" / "data"))
FILES = sorted([*ROOT.glob("samples/*.ply"), *DATA.glob("*.ply")])
# What a range coder's stream may take beyond the cost of its symbols, and a symbol at the most.
STREAM_BITS, ROUNDING_BITS = 8, 2.0**-20


@dataclass(frozen=True)
class Coded:
    """Counts and sizes of a word; n_other leaves out the special S, which are not coded."""

    n_c: int
    n_other: int
    n_specials: int
    n_components: int
    word_bits: int
    special_bits: int

    @classmethod
    def of(cls, faces: Faces, n_vertices: int, table: AnyTable) -> "Coded":
        """Encodes, and decodes to see that the same word comes back."""
        word = connectivity.encode(faces, n_vertices, [table])[0]
        parts = word.word, word.special_integers, word.gluing
        decoded, _ = connectivity.decode(*parts, word.counts, table)
        assert decoded.symbols.tobytes() == word.symbols.tobytes()
        return cls.counted(word)

    @classmethod
    def counted(cls, word: EncodedWord) -> "Coded":
        n = dict(zip(SYMBOLS, np.bincount(word.symbols, minlength=5).tolist(), strict=True))
        n_specials = word.counts.n_specials
        return cls(
            n_c=n["C"],
            n_other=len(word.symbols) - n["C"] - n_specials,
            n_specials=n_specials,
            # E makes the loops and S joins two of them; one is left per component.
            n_components=n["E"] - (n["S"] - n_specials),
            word_bits=8 * len(word.word) if len(word.symbols) else 0,
            special_bits=8 * len(word.special_integers),
        )

    def price(self, found: Certificate) -> float:
        return found.bits_per_c * self.n_c + found.bits_per_other * self.n_other

    def limit(self, found: Certificate) -> float:
        """The most bits that the certificate grants the stream of the word."""
        return (
            self.price(found)
            + found.bits_per_special * self.n_specials
            + found.bits_per_component * self.n_components
            + found.bits_per_word
            + STREAM_BITS
            + ROUNDING_BITS * (self.n_c + self.n_other)
        )


def files() -> Iterator[tuple[str, Faces, int]]:
    """Every sample and every mesh of the data folder."""
    for path in FILES:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ebz.DroppedWarning)
            mesh = ebz.read(path)
        yield path.name, mesh.faces, len(mesh.vertices)

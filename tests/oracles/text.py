"""The coder of text once more, as FORMAT.md has it (sections 11, 13)."""

import math
from typing import Any

from tests.oracles.range_coder import Encoder

U32 = 2**32 - 1


def squash(x: int) -> int:
    return min(round(65536 / (1 + math.exp(-max(-2303, min(2303, x)) / 256))), 65535)


def hashed(text: bytes, order: int) -> int:
    value = order
    for byte in reversed(text[-order:] if order else b""):
        value = (value + byte + 1) * 0x2C9277B5 & U32
    return value ^ value >> 15


class Model:
    def __init__(self) -> None:
        self.weights: dict[tuple[Any, ...], tuple[int, int]] = {}
        self.places: dict[int, int] = {}
        self.match = self.length = 0

    def code(self, coder: Encoder | None, text: bytes, byte: int) -> None:
        hashes = [hashed(text, order) for order in range(7)]
        node = 1
        for i in range(7, -1, -1):
            features: list[tuple[Any, ...]] = [
                (order, ((h + node * 0x9E3779B1) * 0x85EBCA6B & U32) >> 18)
                for order, h in enumerate(hashes)
            ]
            if self.match and (text[self.match] + 256) >> (i + 1) == node:
                features.append(("match", self.length, text[self.match] >> i & 1))
            bit = byte >> i & 1
            self._bit(coder, features, bit)
            node = 2 * node + bit

    def _bit(self, coder: Encoder | None, features: list[tuple[Any, ...]], bit: int) -> None:
        known = [self.weights.get(feature, (0, 0)) for feature in features]
        p = squash(sum(value for value, _ in known) >> 8)
        if coder:
            coder.bit(bool(bit), p)
        for feature, (value, count) in zip(features, known, strict=True):
            moved = value + (((65536 * bit - p) * (80 + 19200 // (16 + count))) >> 12)
            self.weights[feature] = max(-(2**20), min(2**20, moved)), min(count + 1, 255)

    def learn(self, text: bytes) -> None:
        if self.match and text[self.match] == text[-1]:
            self.match, self.length = self.match + 1, min(self.length + 1, 31)
        else:
            self.match = self.length = 0
        if len(text) < 4:
            return
        key = hashed(text, 4) >> 20
        self.match = self.match or self.places.get(key, 0)
        self.places[key] = len(text)


def encode(prior: bytes, text: bytes) -> bytes:
    model, coder, both = Model(), Encoder(), prior + text
    for at, byte in enumerate(both):
        model.code(coder if at >= len(prior) else None, both[:at], byte)
        model.learn(both[: at + 1])
    return coder.finish()

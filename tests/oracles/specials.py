"""The integers of special S once more, in both forms of FORMAT.md, section 6."""

from tests.oracles import integers


def decode(data: bytes, n_specials: int, n_symbols: int) -> dict[int, int]:
    """The half-edge that each special S meets, by position."""
    if not n_specials:
        return {}
    form, body = data[0], data[1:]
    assert form in (0, 1)
    if form == 1:
        rows = _plain(body, n_specials, n_symbols)
    else:
        rows = [(gap, ahead) for gap, ahead in integers.decode(body, n_specials, 2)]
    specials, at = {}, -1
    for gap, ahead in rows:
        at += gap + 1
        specials[at] = ahead + 2 * at + 2
    return specials


def _plain(data: bytes, n_specials: int, n_symbols: int) -> list[tuple[int, int]]:
    bits = "".join(f"{byte:08b}" for byte in data)
    low = max(1, n_symbols // n_specials).bit_length() - 1
    width = (2 * n_symbols).bit_length()
    fields = [bits[i * (low + width) : (i + 1) * (low + width)] for i in range(n_specials)]
    *quotients, padding = bits[n_specials * (low + width) :].split("1")
    assert len(quotients) == n_specials
    assert set(padding) <= {"0"} and len(padding) < 8
    return [
        ((len(quotient) << low) + int("0" + field[:low], 2), int(field[low:], 2))
        for field, quotient in zip(fields, quotients, strict=True)
    ]

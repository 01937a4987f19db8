"""What the levels 1 to 9 mean, stage by stage."""

from functools import cache

from ebz.codec.attributes.plan import Effort as AttributeEffort
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable, load
from ebz.codec.positions import Method
from ebz.codec.word import WordModel

LEVELS = range(1, 10)
DEFAULT_LEVEL = 6
# The certified table to which the adaptive models are compared.
DEFAULT_TABLE = "stack"


def word_effort(level: int) -> Effort:
    """How hard the adaptive model of the word works."""
    if level <= 3:
        return Effort.DIRECT
    return Effort.FAST if level <= 6 else Effort.STRONG


def word_models(level: int) -> list[WordModel]:
    """The first is kept, or the other where that makes the word shorter: see connectivity."""
    return [word_effort(level), default_table()]


@cache
def default_table() -> AnyTable:
    """The certified table, read once."""
    return load(DEFAULT_TABLE)


def position_method(level: int) -> Method:
    """How positions are coded."""
    if level < 3:
        return Method.FAST
    if level < 6:
        return Method.MEDIUM
    return Method.LIGHT if level < 7 else Method.STRONG


def attribute_effort(level: int) -> AttributeEffort:
    """How hard the models of attributes work."""
    if level < 3:
        return AttributeEffort.FAST
    return AttributeEffort.MEDIUM if level < 6 else AttributeEffort.FULL


def guaranteed_by(model: WordModel) -> AnyTable:
    """The table whose certificate bounds a word: adaptive models are kept where that holds."""
    return model if isinstance(model, AnyTable) else default_table()

"""Independent work on several threads: the same results in the same order as on one."""

import os
from collections.abc import Callable, Iterable, Iterator
from contextvars import ContextVar, copy_context
from typing import TypeVar

from ebz.codec.errors import OptionError

Result = TypeVar("Result")
Item = TypeVar("Item")

_threads: ContextVar[int] = ContextVar("threads", default=1)


class using:  # noqa: N801 (used like a function)
    """Lets `run` take up to n threads in this context; 0 means one per core."""

    def __init__(self, n: int) -> None:
        if not hasattr(n, "__index__") or n < 0:
            raise OptionError(f"threads is {n!r}, not an integer of at least 0")
        self._n = n

    def __enter__(self) -> None:
        self._before = _threads.set(self._n or os.cpu_count() or 1)

    def __exit__(self, *error: object) -> None:
        _threads.reset(self._before)


def allowed() -> int:
    """How many threads `run` may take here."""
    return _threads.get()


def run(work: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """The result for each item, in order; of several errors the first item's is raised."""
    return list(each(work, items))


def each(work: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """The results of `run`, one by one as soon as they are there; on one thread, as asked for."""
    items = list(items)
    n_workers = min(allowed(), len(items))
    if n_workers <= 1:
        yield from map(work, items)
        return
    from concurrent.futures import ThreadPoolExecutor

    pool, share = ThreadPoolExecutor(n_workers), allowed() // n_workers  # of work within work
    try:
        futures = [pool.submit(copy_context().run, _with, share, work, item) for item in items]
        for future in futures:
            yield future.result()
    finally:
        pool.shutdown(cancel_futures=True)


def _with(n: int, work: Callable[[Item], Result], item: Item) -> Result:
    with using(n):
        return work(item)

"""Functions of numbers on arrays: broadcasts the arguments, and calls a loop in C in pieces."""

import ctypes
from typing import Any, List, Tuple

import numpy as np

from . import _header as c
from ._library import ArgumentError, library, number

# Elements per call. Between calls Python handles signals, so that Control-C works; some functions take a
# millisecond for one element.
PIECE = 1024


def broadcast(values: List[Tuple[Any, int]], kind: Any = np.float64) -> Tuple[tuple, List[np.ndarray]]:
    """The common shape of arguments, and the arguments as contiguous rows of `width` numbers per element."""
    arrays = [np.asarray(value, dtype=kind) for value, _ in values]
    for array, (_, width) in zip(arrays, values):
        if width > 1 and (array.ndim == 0 or array.shape[-1] != width):
            raise ArgumentError("an array has the shape %s, its last dimension must be %d" % (array.shape, width))
    try:
        shape = np.broadcast_shapes(*(a.shape[:-1] if w > 1 else a.shape for a, (_, w) in zip(arrays, values)))
    except ValueError as error:
        raise ArgumentError("the shapes of the arrays do not fit together: %s" % error) from None
    full = [np.broadcast_to(a, shape + (w,) if w > 1 else shape) for a, (_, w) in zip(arrays, values)]
    return shape, [np.ascontiguousarray(a, dtype=kind).reshape(-1, w) for a, (_, w) in zip(full, values)]


def loop(function: Any, first: List[Any], inputs: List[np.ndarray], outputs: List[np.ndarray]) -> None:
    """Calls function(count, *first, inputs, outputs) for pieces of arrays with one row per element."""
    rows = inputs + outputs
    for at in range(0, len(outputs[0]), PIECE):
        pieces = [ctypes.c_void_p(array[at:at + PIECE].ctypes.data) for array in rows]
        function(ctypes.c_size_t(len(outputs[0][at:at + PIECE])), *first, *pieces)


def each(name: str, choices: List[Tuple[str, str]], model: bool, values: List[Tuple[Any, int]],
         widths: List[int]) -> Any:
    """Calls a loop of each.c. `choices` are pairs of an enumeration and a word; a model takes both in a struct."""
    numbers = [number(enum, text, enum.replace("kiln_", "")) for enum, text in choices]
    first = [ctypes.byref(c.kiln_model(*numbers))] if model else [ctypes.c_int(n) for n in numbers]
    shape, inputs = broadcast(values)
    outputs = [np.empty((len(inputs[0]), width)) for width in widths]
    function = getattr(library, name)
    function.restype = None
    loop(function, first, inputs, outputs)
    results = [out.reshape(shape + ((w,) if w > 1 else ())) for out, w in zip(outputs, widths)]
    return results[0][()] if len(results) == 1 else tuple(result[()] for result in results)

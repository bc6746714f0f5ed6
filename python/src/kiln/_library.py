"""The shared library: loads it, turns its errors into exceptions, and keeps contexts.

A call goes through Context.run, which passes the context first and a kiln_error last, releases the interpreter's
lock (as every call by ctypes.CDLL does), and raises the library's sentence. Options become fields of the
library's structs by fill(); words become enumerators by number().
"""

import collections
import contextlib
import ctypes
import operator
import os
import signal
import threading
import weakref
from typing import Any, Callable, Dict, Iterator, List, Optional

from . import _header as c

Progress = Callable[[str, float], Optional[bool]]


class Error(Exception):
    """A failure of kiln. The text is one sentence that says what happened, with the numbers that matter."""


class ArgumentError(Error, ValueError):
    """A value that was passed in is outside its range."""


class OutOfMemoryError(Error, MemoryError):
    """There is no memory, or the context's limit is reached."""


class FileError(Error, OSError):
    """A file cannot be opened, read, written or renamed."""


class FormatError(Error, ValueError):
    """A file's content is damaged, or not what its name says."""


class UnsupportedError(Error, ValueError):
    """Valid, but of a kind that kiln does not read or write."""


class CancelledError(Error):
    """The progress callback returned False."""


class SourceWarning(UserWarning):
    """A picture may not be what its author meant, or values were cut off."""


_ERRORS = {"argument": ArgumentError, "memory": OutOfMemoryError, "io": FileError, "format": FormatError,
           "unsupported": UnsupportedError, "cancelled": CancelledError}


def _load() -> ctypes.CDLL:
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "libkiln.so")
    loaded = ctypes.CDLL(path)
    for name, (result, arguments) in c.FUNCTIONS.items():
        function = getattr(loaded, name)
        function.restype, function.argtypes = result, arguments
    return loaded


library = _load()
version = library.kiln_version().decode()
_wanted = "%d.%d.%d" % (c.KILN_VERSION_MAJOR, c.KILN_VERSION_MINOR, c.KILN_VERSION_PATCH)
if version != _wanted:
    raise ImportError("libkiln.so is version %s, the package kiln is made for %s" % (version, _wanted))

# ------------------------------------------------------------------------------------------------- words, options


def _names(enum: str) -> Dict[str, int]:
    """The words of an enumeration: those that the library lists, else those of the header."""
    if enum + "_names" not in c.FUNCTIONS:
        return c.WORDS[enum]
    listed = getattr(library, enum + "_names")()
    texts = ctypes.cast(listed, ctypes.POINTER(ctypes.c_char_p))
    count = len(c.WORDS[enum])
    return {texts[i].decode(): i for i in range(count)}


WORDS = {enum: _names(enum) for enum in c.WORDS}


def number(enum: str, word: str, what: str) -> int:
    """The enumerator that a word stands for. `what` names the option in the error."""
    known = WORDS[enum]
    if isinstance(word, str) and word in known:
        return known[word]
    raise ArgumentError("%s is %r, it must be one of %s" % (what, word, ", ".join(known)))


def word(enum: str, value: int) -> str:
    """The word of an enumerator."""
    return next(name for name, known in WORDS[enum].items() if known == value)


def integer(value: Any, what: str) -> int:
    """A number that fits in a C int."""
    value = operator.index(value)
    if not -2**31 <= value < 2**31:
        raise ArgumentError("%s is %d, it must be from -2147483648 to 2147483647" % (what, value))
    return value


def fill(kind: type, /, **options: Any) -> Any:
    """A struct of this kind with these fields; None leaves a field at the library's default."""
    struct = kind()
    types = dict(kind._fields_)
    for name, value in options.items():
        if value is None:
            continue
        if name in c.FIELD_ENUMS[kind.__name__]:
            value = number(c.FIELD_ENUMS[kind.__name__][name], value, name)
        elif types[name] is ctypes.c_int:
            value = integer(value, name)
        elif types[name] is ctypes.c_double:
            value = float(value)
            if value == 0 and name in c.ZERO_FIELDS.get(kind.__name__, []):
                value = c.KILN_ZERO
        setattr(struct, name, value)
    return struct


def path_bytes(path: Any) -> bytes:
    """A path as the library takes it: bytes in the file system's encoding, with a final slash for a folder."""
    text = os.fsencode(path)
    if b"\0" in text:
        raise ArgumentError("the path %r has a character NUL" % (path,))
    return text


def record(kind: Any, struct: Any) -> Any:
    """A NamedTuple from the fields of the same names of a struct."""
    return kind(*(getattr(struct, name) for name in kind._fields))


# -------------------------------------------------------------------------------------------------------- memory


class Memory:
    """A struct whose memory the library frees when nothing refers to this object any more."""

    def __init__(self, struct: Any, free: str) -> None:
        self.struct = struct
        freeing = weakref.finalize(self, getattr(library, free), ctypes.byref(struct))
        freeing.atexit = False  # arrays may outlive the last lines of the program

    def array(self, address: int, shape: tuple) -> Any:
        """A float32 array on the library's memory, which stays as long as the array does."""
        import numpy as np

        buffer = (ctypes.c_float * int(np.prod(shape))).from_address(address)
        buffer.memory = self
        return np.frombuffer(buffer, dtype=np.float32).reshape(shape)


# ------------------------------------------------------------------------------------------------------- contexts


class _Interrupts:
    """Control-C during a call of the library. Python would raise KeyboardInterrupt where the progress callback begins,
    and lose it there; so a handler remembers the signal, the callback stops the work, and the handler that was
    there before runs after the call."""

    pending: Optional[tuple] = None

    def _remember(self, number: int, frame: Any) -> None:
        self.pending = number, frame

    @contextlib.contextmanager
    def later(self) -> Iterator[None]:
        before = None
        if threading.current_thread() is threading.main_thread():  # the only thread that handles signals
            before = signal.getsignal(signal.SIGINT)
        if not callable(before) or before == self._remember:
            yield
            return
        signal.signal(signal.SIGINT, self._remember)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, before)
            pending, self.pending = self.pending, None
            if pending:
                before(*pending)


_interrupts = _Interrupts()
_PROGRESS = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double)


def _destroy(pointer: int, process: int) -> None:
    # In a process made by fork the context's threads do not exist, and waiting for them would never end.
    if os.getpid() == process:
        library.kiln_context_destroy(pointer)


class Context:
    """Threads and memory for kiln's work. Functions without a context use one of their own.

    threads       number of threads, 1 to 256; 0 for one per core
    memory_limit  number of bytes that the context's objects may hold at once; 0 for no limit
    cpu           highest instruction set: "best", "scalar", "sse2", "avx2" or "avx512"; results are the same bits

    A context works for one Python thread at a time; others wait.
    """

    def __init__(self, threads: int = 0, memory_limit: int = 0, cpu: str = "best") -> None:
        if not 0 <= memory_limit < 2 ** (8 * ctypes.sizeof(ctypes.c_size_t)):
            raise ArgumentError("memory_limit is %d, it must be a number of bytes" % memory_limit)
        self._lock = threading.RLock()
        self._progress: Optional[Progress] = None
        self._raised: Optional[BaseException] = None
        this = weakref.ref(self)

        @_PROGRESS
        def report(_user: int, stage: bytes, fraction: float) -> bool:
            context = this()
            return context is None or context._report(stage, fraction)

        self._callback = report
        definition = fill(c.kiln_context_def, thread_count=threads, memory_limit=memory_limit, cpu=cpu)
        definition.progress = ctypes.cast(report, ctypes.c_void_p)
        pointer = ctypes.c_void_p()
        error = c.kiln_error()
        result = library.kiln_context_create(ctypes.byref(definition), ctypes.byref(pointer), ctypes.byref(error))
        check(result, error)
        self._pointer = pointer
        ending = weakref.finalize(self, _destroy, pointer.value, os.getpid())
        ending.atexit = False  # another thread may still be at work when the program ends

    def _report(self, stage: bytes, fraction: float) -> bool:
        # Also without a callback of the caller's, because Python runs the handlers of signals here, such as that of
        # Control-C.
        try:
            if self._raised or _interrupts.pending:
                return False
            return self._progress is None or self._progress(stage.decode(), fraction) is not False
        except BaseException as raised:  # no exception passes through the library
            self._raised = raised
            return False

    def run(self, name: str, *arguments: Any, progress: Optional[Progress] = None) -> None:
        """Calls a function of the library, with the context first and the error last. Raises its failure."""
        error = c.kiln_error()
        with self._lock:
            before = self._progress, self._raised
            self._progress, self._raised = progress, None
            try:
                with _interrupts.later():
                    result = getattr(library, name)(self._pointer, *arguments, ctypes.byref(error))
                    raised = self._raised
            finally:
                self._progress, self._raised = before
        if raised:
            raise raised
        check(result, error)

    @property
    def cpu(self) -> str:
        """The instruction set in use."""
        return library.kiln_context_cpu(self._pointer).decode()

    @property
    def threads(self) -> int:
        """The number of threads that work, with the calling thread."""
        running, wanted = ctypes.c_int(), ctypes.c_int()
        library.kiln_context_threads(self._pointer, ctypes.byref(running), ctypes.byref(wanted))
        return running.value

    @property
    def memory(self) -> tuple:
        """The number of bytes that the context's objects hold now, and the largest number so far."""
        current, peak = ctypes.c_size_t(), ctypes.c_size_t()
        library.kiln_context_memory(self._pointer, ctypes.byref(current), ctypes.byref(peak))
        return current.value, peak.value


def check(result: int, error: Any) -> None:
    """Raises the exception of a kiln_result that is not OK."""
    if result:
        kind = _ERRORS[word("kiln_result", result).replace("error-", "")]
        raise kind(error.message.decode("utf-8", "replace"))


def call(name: str, *arguments: Any) -> None:
    """Calls a function that fails but takes no context."""
    error = c.kiln_error()
    check(getattr(library, name)(*arguments, ctypes.byref(error)), error)


# Contexts that nobody uses at the moment. Each Python thread that works takes one, so that threads do not wait for
# each other.
_idle: "collections.deque[Context]" = collections.deque()
_left: List[Context] = []


def _forked() -> None:
    _left.extend(_idle)
    _idle.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forked)


@contextlib.contextmanager
def borrow(context: Optional[Context]) -> Iterator[Context]:
    """The caller's context, or one that nobody uses."""
    if context is not None:
        yield context
        return
    try:
        own = _idle.pop()
    except IndexError:
        own = Context()
    try:
        yield own
    finally:
        _idle.append(own)

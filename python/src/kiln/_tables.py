"""Tables of integrals of reflection models, closed forms fitted to them, and random walks between microfacets."""

import ctypes
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike

from . import _header as c
from ._each import broadcast, loop
from ._library import Context, Memory, Progress, borrow, fill, integer, library, path_bytes, word


class Table:
    """A table of a reflection model's integral.

    texels    float32 array (height, width, channels), or (depth, height, width, channels) for tables with slices.
              Columns run along n.v, rows along roughness, slices along F0 or the index of refraction
    kind, d, g, sheen, axis   words: what the table holds
    corners, complement, flip   as for kiln.table
    tap_count, level_roughness  for tables of lobes, else 0 and empty
    """

    def __init__(self, struct: Any) -> None:
        memory = Memory(struct, "kiln_table_free")
        self._struct = struct
        definition, image = getattr(struct, "def"), struct.image  # the field has the name of a keyword
        self._def = definition
        shape = (definition.height, definition.width, image.channels)
        if definition.depth > 1:
            shape = (definition.depth,) + shape
        self.texels = memory.array(image.pixels, shape)
        self.kind = word("kiln_table_kind", definition.kind)
        self.d, self.g = word("kiln_d", definition.model.d), word("kiln_g", definition.model.g)
        self.sheen, self.axis = word("kiln_sheen", definition.sheen), word("kiln_axis", definition.axis)
        self.corners: bool = definition.corners
        self.complement: bool = definition.complement
        self.flip: bool = definition.flip
        self.path_count: int = definition.path_count
        self.tap_count: int = definition.tap_count
        self.level_roughness: Tuple[float, ...] = tuple(definition.level_roughness[:definition.level_count])

    def __repr__(self) -> str:
        return "<kiln.Table: %s, %s>" % (self.kind, " x ".join(str(n) for n in self.texels.shape))

    def lookup(self, nov: ArrayLike, roughness: ArrayLike, third: ArrayLike = 0.0) -> np.ndarray:
        """The table's value between texels, as graphics hardware interpolates. The arguments broadcast; third is F0 or
        the ior of tables with slices. float64 of the arguments' shape, with a last dimension of the channels if there
        are several, or of the 4 (tap_count + 1) numbers of all slices of a table of lobes. A stored complement is
        undone."""
        shape, rows = broadcast([(nov, 1), (roughness, 1), (third, 1)])
        channels = self._struct.image.channels * (self.tap_count + 1 if self.kind == "lobes" else 1)
        values = np.empty((len(rows[0]), channels))
        library.kiln_each_table_lookup.restype = None
        loop(library.kiln_each_table_lookup, [ctypes.byref(self._struct)], rows, [values])
        return values.reshape(shape + ((channels,) if channels > 1 else ()))[()]

    def coordinates(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """nov, roughness and third of each texel: float64 arrays of the shape of the texels without channels."""
        arrays = [np.empty(self.texels.shape[:-1]) for _ in range(3)]
        library.kiln_each_table_texel.restype = None
        library.kiln_each_table_texel(ctypes.byref(self._struct), *(ctypes.c_void_p(a.ctypes.data) for a in arrays))
        return arrays[0], arrays[1], arrays[2]

    def average(self, height: Optional[int] = None, *, context: Optional[Context] = None) -> "Table":
        """The table of E_avg of what lookups in this table of E return; height texels, None for 1024."""
        made = c.kiln_table()
        with borrow(context) as used:
            used.run("kiln_table_average", ctypes.byref(self._struct), integer(height or 0, "height"),
                     ctypes.byref(made))
        return Table(made)

    def save(self, path: Any, format: str = "auto", zstd: int = 0, name: Optional[str] = None, *,
             context: Optional[Context] = None) -> None:
        """Writes the table; docs/tables.md describes the files by their endings.

        format  "auto", "f32", "f16", "u16", "u8" or "rgbd"
        zstd    compression level of a KTX2 file, 1 to 22; 0 for none
        name    beginning of the names in .h and .glsl; None for the file's own name
        """
        definition = fill(c.kiln_table_save_def, format=format, zstd=zstd, name=None if name is None else name.encode())
        with borrow(context) as used:
            used.run("kiln_table_save", ctypes.byref(self._struct), path_bytes(path), ctypes.byref(definition))

    def save_lookup(self, path: Any, name: Optional[str] = None, *, context: Optional[Context] = None) -> None:
        """Writes a function that looks up values in the table: C (.h) or GLSL ES 3.00 (.glsl)."""
        with borrow(context) as used:
            used.run("kiln_table_lookup_save", ctypes.byref(self._def), path_bytes(path),
                     None if name is None else name.encode())


def table(kind: str = "e", *, d: str = "ggx", g: str = "smith", sheen: str = "ashikhmin", width: Optional[int] = None,
          height: Optional[int] = None, depth: Optional[int] = None, axis: str = "linear", corners: bool = False,
          complement: bool = False, flip: bool = False, path_count: Optional[int] = None,
          tap_count: Optional[int] = None, level_roughness: Sequence[float] = (),
          progress: Optional[Progress] = None, context: Optional[Context] = None) -> Table:
    """Computes a table.

    kind        "e", "eavg", "dfg", "dfg-multiscatter", "sheen", "e-dielectric", "glass", "e-walk" or "lobes":
                docs/tables.md
    d, g        the model, as in kiln.brdf
    sheen       "ashikhmin" or "estevez"
    width, height, depth   texels, 1 to 4096; None for 128 x 128, or 32 x 32 x 32 with slices
    axis        how n.v depends on the column: "linear", "sqrt", "cbrt" or "grazing"
    corners     True: texel i of n lies at i / (n - 1); False: at (i + 1/2) / n
    complement  True: stores 1 - value
    flip        True: row 0 holds roughness 1
    path_count  random walks per texel of "e-walk"; None for 8192
    tap_count   lookups of "lobes", 1 to 3; None for 1
    level_roughness   roughness of the levels that "lobes" reads, 2 to 16 increasing numbers; () for seven equal steps
    """
    definition = fill(c.kiln_table_def, kind=kind, sheen=sheen, width=width, height=height, depth=depth, axis=axis,
                      corners=corners, complement=complement, flip=flip, path_count=path_count, tap_count=tap_count,
                      level_count=len(level_roughness))
    if len(level_roughness) > len(definition.level_roughness):
        raise ValueError("level_roughness has %d numbers, at most %d are allowed"
                         % (len(level_roughness), len(definition.level_roughness)))
    definition.level_roughness[:len(level_roughness)] = [float(r) for r in level_roughness]
    definition.model = fill(c.kiln_model, d=d, g=g)
    made = c.kiln_table()
    with borrow(context) as used:
        used.run("kiln_table_create", ctypes.byref(definition), ctypes.byref(made), progress=progress)
    return Table(made)


def load_table(path: Any, *, context: Optional[Context] = None) -> Table:
    """Reads a table from a KTX2 file that kiln wrote."""
    made = c.kiln_table()
    with borrow(context) as used:
        used.run("kiln_table_load", path_bytes(path), ctypes.byref(made))
    return Table(made)


class Fit:
    """A closed form of a function of n.v and roughness.

    max_error, rms_error   absolute errors against the exact integrals
    coefficient_count      number of coefficients in all
    """

    def __init__(self, struct: Any) -> None:
        self._struct = struct
        self.kind = word("kiln_fit_kind", getattr(struct, "def").kind)
        self.max_error: float = struct.max_error
        self.rms_error: float = struct.rms_error
        self.coefficient_count: int = struct.coefficient_count

    def __repr__(self) -> str:
        return "<kiln.Fit: %s, %d coefficients, error %.2g>" % (self.kind, self.coefficient_count, self.max_error)

    def evaluate(self, nov: ArrayLike, roughness: ArrayLike) -> np.ndarray:
        """The closed form in float32: of the arguments' broadcast shape, (..., 2) with A and B for "dfg"."""
        shape, rows = broadcast([(nov, 1), (roughness, 1)], np.float32)
        width = 2 if self.kind == "dfg" else 1
        values = np.empty((len(rows[0]), width), np.float32)
        library.kiln_each_fit_evaluate.restype = None
        loop(library.kiln_each_fit_evaluate, [ctypes.byref(self._struct)], rows, [values])
        return values.reshape(shape + ((2,) if width == 2 else ()))[()]

    def save(self, path: Any, name: Optional[str] = None, *, context: Optional[Context] = None) -> None:
        """Writes the closed form as a function in C (.h) or GLSL ES 3.00 (.glsl)."""
        with borrow(context) as used:
            used.run("kiln_fit_save", ctypes.byref(self._struct), None if name is None else name.encode(),
                     path_bytes(path))


def fit(kind: str = "e", *, d: str = "ggx", g: str = "smith", form: str = "auto", error: Optional[float] = None,
        roughness_min: Optional[float] = None, max_coefficients: Optional[int] = None,
        progress: Optional[Progress] = None, context: Optional[Context] = None) -> Fit:
    """Finds the closed form with the fewest coefficients whose error is at most `error`, 1e-6 to 0.5 (None for 1e-3).

    kind  "e", "e-average", "dfg" or "sheen"
    form  "auto", "polynomial" or "rational"
    roughness_min     smallest roughness of the fit, 0 to 0.9
    max_coefficients  of each part of the form, 1 to 160
    """
    definition = fill(c.kiln_fit_def, kind=kind, form=form, error=error, roughness_min=roughness_min,
                      max_coefficients=max_coefficients)
    definition.model = fill(c.kiln_model, d=d, g=g)
    made = c.kiln_fit()
    with borrow(context) as used:
        used.run("kiln_fit_create", ctypes.byref(definition), ctypes.byref(made), progress=progress)
    return Fit(made)


class Walk(NamedTuple):
    """The share of light that a surface reflects with all bounces, as estimated by random walks."""

    albedo: np.ndarray
    standard_error: np.ndarray  #: of the albedo, from 16 independent groups of paths
    bounce: np.ndarray  #: (..., 16): albedo by the number of bounces; the last counts all further bounces


def walk(roughness: ArrayLike, nov: ArrayLike, *, fresnel: str = "schlick", f0: float = 0.0, n: float = 0.0,
         k: float = 0.0, path_count: Optional[int] = None, seed: int = 0) -> Walk:
    """Albedo of a GGX surface with all bounces, by random walks between the microfacets.

    fresnel     "schlick" with f0, "constant" (the constant f0; 1 for a white furnace), or "conductor" with n + i k
    path_count  number of paths, rounded up to a power of 2; None for 65536
    The arguments roughness and nov broadcast.
    """
    shape, rows = broadcast([(roughness, 1), (nov, 1)])
    definition = fill(c.kiln_walk_def, fresnel=fresnel, f0=f0, n=n, k=k, path_count=path_count, seed=seed)
    results: List[Any] = []
    for r, v in zip(rows[0].ravel(), rows[1].ravel()):
        made = c.kiln_walk()
        library.kiln_walk_albedo(ctypes.byref(definition), r, v, ctypes.byref(made))
        results.append((made.albedo, made.standard_error, list(made.bounce)))
    return Walk(np.array([a for a, _, _ in results]).reshape(shape)[()],
                np.array([e for _, e, _ in results]).reshape(shape)[()],
                np.array([b for _, _, b in results]).reshape(shape + (c.KILN_WALK_BOUNCES,)))

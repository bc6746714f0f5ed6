"""Bakes environments: prefiltered levels, irradiance, harmonics and lights, and the engines that read them."""

import ctypes
from typing import Any, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _header as c
from ._each import broadcast, loop
from ._library import (ArgumentError, Context, Memory, Progress, borrow, call, fill, integer, library, number,
                       path_bytes, word)
from ._maps import (Map, Note, SaveReport, Source, out_path, own_map, read_source, save_report, take_files, warn_of)

# ------------------------------------------------------------------------------------------------------ harmonics


class Harmonics:
    """Coefficients of real, orthonormal spherical harmonics, without the Condon-Shortley sign.

    c           float64 array (bands * bands, 3). Row l (l + 1) + m belongs to degree l and order m. As functions of
                directions (y up) the rows are proportional to 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, ...
    irradiance  True: the coefficients are of irradiance; False: of radiance
    window      width of the deringing window in bands, 0 for none
    """

    def __init__(self, coefficients: ArrayLike, irradiance: bool = False, window: float = 0.0) -> None:
        self.c = np.array(coefficients, dtype=np.float64)
        counts = [b * b for b in range(1, c.KILN_MAX_BANDS + 1)]
        if self.c.ndim != 2 or self.c.shape[1] != 3 or self.c.shape[0] not in counts:
            raise ArgumentError("coefficients have the shape %s, it must be (n, 3) with n one of %s" %
                                (self.c.shape, ", ".join(map(str, counts))))
        self.irradiance, self.window = irradiance, window

    @property
    def bands(self) -> int:
        """Number of bands, 1 to 5."""
        return int(round(len(self.c) ** 0.5))

    def __repr__(self) -> str:
        return "<kiln.Harmonics: %d bands of %s>" % (self.bands, "irradiance" if self.irradiance else "radiance")

    def struct(self) -> Any:
        """The library's struct of the coefficients."""
        made = c.kiln_sh(self.bands, self.irradiance, self.window)
        np.ctypeslib.as_array(made.c)[:len(self.c)] = self.c
        return made

    def filter(self, bands: Optional[int] = None, irradiance: bool = False, window: float = 0.0) -> "Harmonics":
        """The first bands (None for all) as irradiance (band l times pi, 2 pi/3, pi/4, 0, -pi/24), or multiplied by
        the Hanning window (1 + cos(pi l / window)) / 2 if window > 0. These harmonics must be of radiance."""
        made = c.kiln_sh()
        call("kiln_sh_filter", ctypes.byref(self.struct()), integer(bands or self.bands, "bands"), irradiance, window,
             ctypes.byref(made))
        return harmonics_of(made)

    def evaluate(self, directions: ArrayLike) -> np.ndarray:
        """The sum of the harmonics in unit directions (..., 3): float64 (..., 3), which may be negative."""
        shape, (rows,) = broadcast([(directions, 3)])
        values = np.empty_like(rows)
        library.kiln_each_sh_evaluate.restype = None
        loop(library.kiln_each_sh_evaluate, [ctypes.byref(self.struct())], [rows], [values])
        return values.reshape(shape + (3,))

    def save(self, path: Any, *, context: Optional[Context] = None) -> None:
        """Writes the coefficients to a .json, .txt or .h file."""
        with borrow(context) as used:
            used.run("kiln_sh_save", ctypes.byref(self.struct()), path_bytes(path))


def harmonics_of(struct: Any) -> Harmonics:
    return Harmonics(np.ctypeslib.as_array(struct.c)[:struct.bands * struct.bands], struct.irradiance, struct.window)


def harmonics(source: Source, bands: int = 3, *, irradiance: bool = False, window: float = 0.0, rotation: float = 0.0,
              context: Optional[Context] = None) -> Harmonics:
    """The spherical harmonics of an environment, in milliseconds.

    bands     1 to 5: bands * bands coefficients
    rotation  degrees about +Y
    irradiance and window are as for Harmonics.filter.
    """
    made = c.kiln_sh()
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, None, 3)
        used.run("kiln_map_sh", read.checked(), integer(bands, "bands"), rotation, ctypes.byref(made))
    radiance = harmonics_of(made)
    return radiance.filter(bands, irradiance, window) if irradiance or window else radiance


# --------------------------------------------------------------------------------------------------------- lights


class Light(NamedTuple):
    """A compact source of light, such as the sun, as a disc of uniform radiance."""

    direction: Tuple[float, float, float]  #: unit vector to the light
    irradiance: Tuple[float, float, float]  #: of a surface that faces the light: radiance times steradian
    angular_radius: float  #: degrees
    share: float  #: the part of the map's light that this light holds, 0 to 1
    texel_count: int


def lights_of(struct: Any) -> List[Light]:
    return [Light(tuple(a.direction), tuple(a.irradiance), a.angular_radius, a.share, a.texel_count)
            for a in struct.light[:struct.count]]


def lights(source: Source, count: Optional[int] = None, share: Optional[float] = None, *,
           context: Optional[Context] = None) -> List[Light]:
    """The compact lights of an environment, the one with the largest share first.

    count  largest number of lights, 1 to 64; None for 1, or for 64 if share is given
    share  smallest share of a light, 0 to 1; None for 0.01
    """
    definition, made = fill(c.kiln_lights_def, count=count, share=share), c.kiln_lights()
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, None, 3)
        used.run("kiln_lights_find", read.checked(), ctypes.byref(definition), ctypes.byref(made))
    return lights_of(made)


# -------------------------------------------------------------------------------------------------------- engines


class Engine:
    """The form in which a rendering engine reads an environment."""

    def __init__(self, pointer: Any) -> None:
        self._pointer = pointer
        struct = pointer.contents
        self.name: str = struct.name.decode()  #: short name, for example "three"
        self.title: str = struct.title.decode()  #: full name and version
        self.files: str = struct.files.decode()  #: names of the written files, for example "NAME.ktx2"
        self.ending: str = struct.ending.decode()  #: ending of the path to save to; "" for the beginning of names
        self.mapping: str = struct.mapping.decode()  #: formula for the roughness of level k of n
        self.size: int = struct.size  #: default size of a cube face in texels
        self.level_count: int = struct.level_count  #: default number of levels
        self.limit: float = struct.limit  #: largest radiance that the files hold in the default format
        self.proof: str = struct.proof.decode()  #: what the support is proved by
        self.tune: bool = struct.tune  #: True if tuned levels are the default
        reason: Optional[bytes] = struct.format_reason
        #: why the first format is the default; empty without a choice
        self.format_reason: str = reason.decode() if reason else ""

    def __repr__(self) -> str:
        return "<kiln.Engine: %s>" % self.title

    def ending_of(self, format: str) -> str:
        """The ending of the path to save to with a format, such as "uastc"."""
        value: bytes = library.kiln_engine_ending(self._pointer, number("kiln_format", format, "format"))
        return value.decode()

    def level(self, roughness: ArrayLike, size: int = 0, level_count: int = 0) -> np.ndarray:
        """The level, with its fraction, that the engine's shader reads for a roughness of 0 to 1. 0 stands for the
        engine's own size and number of levels. -1 for numbers out of range."""
        rows = np.asarray(roughness, dtype=np.float64)
        size, level_count = size or self.size, level_count or self.level_count
        values = [library.kiln_engine_level(self._pointer, r, size, level_count) for r in rows.ravel()]
        return np.array(values).reshape(rows.shape)[()]

    def show(self, cube: Map, roughness: float, directions: ArrayLike, *,
             context: Optional[Context] = None) -> np.ndarray:
        """What the engine shows of a cube in directions (..., 3): two neighbouring levels, each read bilinearly, mixed
        by the fraction of the level. float64 (..., 3)."""
        shape, (rows,) = broadcast([(directions, 3)])
        values = np.empty_like(rows)
        with borrow(context) as used:
            used.run("kiln_engine_show", self._pointer, cube.checked(), roughness,
                     ctypes.c_void_p(rows.ctypes.data), len(rows), ctypes.c_void_p(values.ctypes.data))
        return values.reshape(shape + (3,))


def engines() -> List[Engine]:
    """All engines whose files kiln writes."""
    found: List[Engine] = []
    while True:
        pointer = library.kiln_engine_at(len(found))
        if not pointer:
            return found
        found.append(Engine(pointer))


def engine(name: Union[str, Engine]) -> Engine:
    """The engine of this name."""
    if isinstance(name, Engine):
        return name
    pointer = library.kiln_engine_find(name.encode())
    if not pointer:
        raise ArgumentError("engine is %r, it must be one of %s" % (name, ", ".join(e.name for e in engines())))
    return Engine(pointer)


# --------------------------------------------------------------------------------------------------- environments


class EnvironmentReport(NamedTuple):
    """What Environment.save wrote."""

    file_count: int
    levels: SaveReport
    irradiance: SaveReport


class Environment:
    """What lights a scene, all computed from one source.

    levels      list of float32 arrays, prefiltered radiance: (6, n, n, 3) for a cube
    roughness   float32 array, the roughness in [0, 1] of each level
    irradiance  float32 array, irradiance / pi, of the shape of a level; None where none was asked for
    sh          Harmonics of the radiance
    lights      the lights that were taken out: a list of Light
    clamped     the largest value that a texel was clamped to; 0 if the source was not clamped
    engine      the Engine that the levels are for, or None
    notes       what the loader found, chose and changed: a list of Note
    map         the levels as a Map; irradiance_map is the irradiance as a Map, or None

    The arrays of levels and irradiance are those of the library: what you change in them is saved.
    """

    def __init__(self, struct: Any, for_engine: Optional[Engine], notes: List[Note]) -> None:
        self._struct = struct
        memory = Memory(struct, "kiln_environment_free")
        self.map = own_map(struct.levels, notes, memory)
        self.irradiance_map = own_map(struct.irradiance, notes, memory) if struct.irradiance.level_count else None
        self.levels = self.map.levels
        self.roughness = self.map.roughness
        self.irradiance = self.irradiance_map.levels[0] if self.irradiance_map else None
        self.sh = harmonics_of(struct.sh)
        self.lights = lights_of(struct.lights)
        self.clamped: float = struct.clamped.limit
        self.lobe = word("kiln_lobe_kind", struct.lobe)
        self.engine = for_engine
        self.notes = notes

    def __repr__(self) -> str:
        kind = "for %s, " % self.engine.name if self.engine else ""
        return "<kiln.Environment: %s%s, %d, %d levels>" % (kind, self.map.shape, self.map.size, len(self.levels))

    def _checked(self) -> Any:
        self.map.checked()
        if self.irradiance_map:
            self.irradiance_map.checked()
        return ctypes.byref(self._struct)

    def _definition(self, format: str, zstd: int, irradiance: Any, sh: Any, lights_path: Any, sh_bands: Optional[int],
                    sh_irradiance: bool, sh_window: float) -> Any:
        definition = fill(c.kiln_environment_save_def, format=format, zstd=zstd,
                          irradiance_path=None if irradiance is None else out_path(irradiance),
                          sh_path=None if sh is None else path_bytes(sh),
                          lights_path=None if lights_path is None else path_bytes(lights_path))
        if self.engine:
            definition.engine = self.engine._pointer
        if sh is not None:
            filtered = self.sh.filter(sh_bands, sh_irradiance, sh_window)
            definition.sh = ctypes.pointer(filtered.struct())
        return definition

    def save(self, path: Any, format: str = "auto", zstd: int = 0, *, irradiance: Any = None, sh: Any = None,
             lights: Any = None, sh_bands: Optional[int] = None, sh_irradiance: bool = False, sh_window: float = 0.0,
             context: Optional[Context] = None) -> EnvironmentReport:
        """Writes the environment; either all files appear or none. The bytes are those of `kiln bake`.

        path        file or files of the levels, as for Map.save; for an engine, the file or the beginning of the
                    names of the files that the engine loads
        format      as for Map.save; for an engine one of the engine's formats
        zstd        compression level of KTX2 files that are not for an engine, 1 to 22; 0 for none
        irradiance  path of the irradiance map; None for none
        sh          path of the harmonics (.json, .txt or .h); None for none
        lights      path of the lights (.json); None for none
        sh_bands, sh_irradiance, sh_window   what is written to the path of the harmonics: see Harmonics.filter
        """
        report = c.kiln_environment_report()
        definition = self._definition(format, zstd, irradiance, sh, lights, sh_bands, sh_irradiance, sh_window)
        with borrow(context) as used:
            used.run("kiln_environment_save", self._checked(), out_path(path), ctypes.byref(definition),
                     ctypes.byref(report))
        return EnvironmentReport(report.file_count, save_report(report.levels, path),
                                 save_report(report.irradiance, irradiance or path))

    def encode(self, name: str, format: str = "auto", zstd: int = 0, *, irradiance: Any = None, sh: Any = None,
               lights: Any = None, sh_bands: Optional[int] = None, sh_irradiance: bool = False,
               sh_window: float = 0.0, context: Optional[Context] = None) -> Dict[str, bytes]:
        """The files that save would write, by name, those of the levels first."""
        files, report = c.kiln_files(), c.kiln_environment_report()
        definition = self._definition(format, zstd, irradiance, sh, lights, sh_bands, sh_irradiance, sh_window)
        with borrow(context) as used:
            used.run("kiln_environment_encode", self._checked(), path_bytes(name), ctypes.byref(definition),
                     ctypes.byref(files), ctypes.byref(report))
        save_report(report.levels, name)
        return take_files(files)


def _roughness(roughness: Optional[ArrayLike]) -> Optional[Any]:
    if roughness is None:
        return None
    values = np.asarray(roughness, dtype=np.float32)
    if values.ndim != 1 or not 1 <= len(values) <= c.KILN_MAX_LEVELS:
        raise ArgumentError("roughness has the shape %s, it must be a list of 1 to %d numbers" %
                            (values.shape, c.KILN_MAX_LEVELS))
    return (ctypes.c_float * len(values))(*values)


def _cut_notes(report: Any, struct: Any) -> List[Note]:
    """Sentences about values below zero that filtering left and that became 0."""
    found: List[Note] = []
    for cut in (struct.levels_cut, struct.irradiance_cut):
        note = c.kiln_note()
        if library.kiln_cut_note(ctypes.byref(report), ctypes.byref(cut), ctypes.byref(note)):
            found.append(Note(word("kiln_note_kind", note.kind), note.warning, note.text.decode()))
    return found


def bake(source: Source, engine: Union[str, Engine, None] = None, size: Optional[int] = None, *,
         level_count: Optional[int] = None, shape: str = "auto", lobe: Optional[str] = None,
         roughness: Optional[ArrayLike] = None, tune: str = "auto", rotation: float = 0.0, pitch: float = 0.0,
         roll: float = 0.0, up: str = "y", mirror: bool = False, exposure: float = 0.0,
         irradiance_size: Optional[int] = None, sh_bands: Optional[int] = None, sun: str = "keep",
         light_count: Optional[int] = None, light_share: Optional[float] = None, clamp: Optional[float] = None,
         tolerance: Optional[float] = None, layout: str = "auto", negative: str = "keep",
         layer: Optional[str] = None, progress: Optional[Progress] = None,
         context: Optional[Context] = None) -> Environment:
    """Bakes an environment: prefiltered levels, an irradiance map and spherical harmonics.

    source           a path, the bytes of a file, six paths of cube faces, a Map, or an array of linear radiance of the
                     shape (height, width, 3 or 4) or (6, n, n, 3 or 4): see load and from_array
    engine           name of the engine that the levels are for, for example "three"; None for GGX levels whose
                     roughness goes from 0 to 1 in equal steps. kiln.engines() lists the engines
    size             texels along the edge of a face of level 0, or rows of a panorama, 1 to 32768; None for 256, or
                     for the engine's default
    level_count      1 to 16; None for all levels down to one texel, or for the engine's default
    shape            of the levels: "cube" (also "auto"), "panorama" or "octahedron"
    lobe             "ggx" (None), "lambert", "charlie" or "phong"; an engine decides its own
    roughness        of each level, numbers in [0, 1]; an engine decides its own
    tune             whether levels are tuned for the engine: "auto", "none", "sharp" or "soft"
    rotation, pitch, roll   turns of the source in degrees about +Y, +X and the view axis -Z
    up               the axis that points up in the source: "y", "z" or "minus-z"
    mirror           True: swaps left and right of the source
    exposure         multiplies the source by 2^exposure
    irradiance_size  1 to 32768; None for 64, 0 for no irradiance map
    sh_bands         bands of harmonics, 1 to 5; None for 3
    sun              what becomes of compact lights: "keep", "extract" or "clamp"
    light_count, light_share   which lights are taken out, as for lights
    clamp            largest radiance with sun="clamp"; None for the library's choice
    tolerance        decides where the spectrum is cut off, 1e-6 to 0.01; None for 1.5e-4
    layout, negative, layer    how the source is read, as for load
    progress         called with a stage and a fraction in [0, 1] from time to time; returns False to stop
    context          threads and memory; None for a context with one thread per core

    Raises kiln.Error, whose subclasses are ArgumentError, FileError, FormatError, UnsupportedError, OutOfMemoryError
    and CancelledError. The interpreter's lock is released during the work. Results are the same bits for every
    number of threads and every processor, and those of the command `kiln bake`.
    """
    chosen = None if engine is None else _engine(engine)
    numbers = _roughness(roughness)
    if numbers is not None and level_count is None:
        level_count = len(numbers)
    if numbers is not None and level_count != len(numbers):
        raise ArgumentError("roughness has %d numbers, but level_count is %d" % (len(numbers), level_count or 0))
    definition = fill(c.kiln_bake_def, tune=tune, mirror=mirror, exposure=exposure, sh_bands=sh_bands, sun=sun,
                      irradiance_size=c.KILN_NO_IRRADIANCE if irradiance_size == 0 else irradiance_size, clamp=clamp)
    definition.levels = fill(c.kiln_prefilter_def, shape=shape, size=size, level_count=level_count, lobe=lobe,
                             rotation=rotation, pitch=pitch, roll=roll, up=up, tolerance=tolerance)
    definition.levels.roughness = ctypes.cast(numbers, ctypes.c_void_p) if numbers is not None else None
    definition.lights = fill(c.kiln_lights_def, count=light_count, share=light_share)
    if chosen:
        definition.engine = chosen._pointer
    struct = c.kiln_environment()
    with borrow(context) as used:
        read = read_source(source, used, layout, negative, layer, progress, 3)
        used.run("kiln_bake", read.checked(), ctypes.byref(definition), ctypes.byref(struct), progress=progress)
    notes = read.notes + _cut_notes(read.report(), struct)
    warn_of(notes[len(read.notes):], source if isinstance(source, str) else "source", 3)
    return Environment(struct, chosen, notes)


_engine = engine  # under another name in bake, which has a parameter `engine`

"""Pictures of all directions: maps, how they are read, made, converted and saved."""

import ctypes
import os
import warnings
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _header as c
from ._each import broadcast
from ._library import (ArgumentError, Context, Memory, Progress, SourceWarning, borrow, fill, integer, library,
                       number, path_bytes, record, word)

FACES = 6


class Note(NamedTuple):
    """One thing to know about a picture that was read."""

    kind: str  #: what the note is about: infinite, nan, negative, missing, choice, conversion, assumption or cut
    warning: bool  #: True: the environment may not be what its author meant
    text: str  #: a sentence without a capital and a full stop


class SaveReport(NamedTuple):
    """What was saved, and how many values were too large for the files' format."""

    file_count: int
    limit: float  #: largest radiance that the format holds; 0 if floats hold every radiance
    value_count: int  #: number of values in all levels, three per texel
    cut_count: int  #: number of values above the limit, which the files hold as the limit
    share: float  #: cut_count / value_count
    light_share: float  #: light above the limit relative to all light of the map
    largest: float  #: largest value of the map


def level_shape(shape: str, size: int) -> Tuple[int, ...]:
    """The shape of the array of a level: (6, n, n, 3), (n, 2n, 3) or (n, n, 3)."""
    return {"cube": (FACES, size, size, 3), "panorama": (size, 2 * size, 3), "octahedron": (size, size, 3)}[shape]


class Map:
    """Radiance by direction.

    shape      "panorama", "cube" or "octahedron"
    levels     float32 arrays, one a level: (n, 2n, 3) for a panorama, (6, n, n, 3) for a cube with the faces
               +X -X +Y -Y +Z -Z, (n, n, 3) for an octahedron. Rows run from top to bottom. Values are linear
               radiance with Rec. 709 primaries in the unit of the input. Level k has the size n >> k, at least 1.
    roughness  float32 array, the roughness in [0, 1] that each level was filtered for
    notes      what the loader found, chose and changed: a list of Note

    Map(levels) makes a map on your own arrays: float32, contiguous and finite. The arrays are not copied. For
    pixels of other kinds, or with bad values, use kiln.from_array.
    """

    def __init__(self, levels: Union[np.ndarray, Sequence[np.ndarray]], roughness: Optional[ArrayLike] = None,
                 shape: Optional[str] = None) -> None:
        arrays = [levels] if isinstance(levels, np.ndarray) else list(levels)
        if not 1 <= len(arrays) <= c.KILN_MAX_LEVELS:
            raise ArgumentError("a map of %d levels, it must have 1 to %d" % (len(arrays), c.KILN_MAX_LEVELS))
        shape = shape or _shape_of(arrays[0])
        size = arrays[0].shape[1] if shape == "cube" else arrays[0].shape[0]
        smallest = arrays[-1].shape[1] if shape == "cube" else arrays[-1].shape[0]
        struct = c.kiln_map(number("kiln_shape", shape, "shape"), size, len(arrays), smallest)
        for k, array in enumerate(arrays):
            wanted = level_shape(shape, max(1, smallest, size >> k))
            if array.shape != wanted or array.dtype != np.float32 or not array.flags.c_contiguous:
                raise ArgumentError("level %d is %s of the shape %s, it must be contiguous float32 of the shape %s" %
                                    (k, array.dtype, array.shape, wanted))
            struct.level[k] = array.ctypes.data
        self._take(struct, arrays, [], struct)
        if roughness is not None:
            self.roughness[:] = roughness

    def _take(self, struct: Any, arrays: List[np.ndarray], notes: List[Note], memory: Any) -> None:
        self._struct = struct
        self.shape = word("kiln_shape", struct.shape)
        self.levels = arrays
        numbers = (ctypes.c_float * len(arrays)).from_buffer(struct, c.kiln_map.roughness.offset)
        numbers.memory = memory  # which the library clears when nothing refers to it any more
        self.roughness = np.frombuffer(numbers, dtype=np.float32)
        self.notes = notes
        self._report: Any = None

    def report(self) -> Any:
        """What the loader found, as a kiln_load_report. For the caller's own arrays it counts negative texels."""
        if self._report is None:
            negative = int((self.levels[0] < 0).any(axis=-1).sum())
            return c.kiln_load_report(texel_count=self.levels[0].size // 3, negative_count=negative)
        return self._report

    @property
    def size(self) -> int:
        """Size of level 0 in texels along its short side."""
        return self._struct.size

    def __repr__(self) -> str:
        return "<kiln.Map: %s, %d, %d levels>" % (self.shape, self.size, len(self.levels))

    def checked(self) -> Any:
        """The library's struct of the map, whose values are finite now."""
        for k, array in enumerate(self.levels):
            if not np.isfinite(array).all():
                raise ArgumentError("level %d has values that are infinite or not a number; kiln.from_array "
                                    "replaces them" % k)
            if array.ctypes.data != self._struct.level[k]:
                raise ArgumentError("level %d is another array; change the values of the array, or make a map by "
                                    "Map(levels)" % k)
        return ctypes.byref(self._struct)

    def directions(self, level: int = 0) -> np.ndarray:
        """Unit directions of the centres of a level's texels, float64 in the shape of the level."""
        if not 0 <= level < len(self.levels):
            raise ArgumentError("level is %d, it must be 0 to %d" % (level, len(self.levels) - 1))
        # The loop counts texels from 0, so that it takes the level in one piece.
        out = np.empty(self.levels[level].shape)
        library.kiln_each_map_direction.restype = None
        library.kiln_each_map_direction(ctypes.c_size_t(out.size // 3), ctypes.byref(self._struct),
                                        ctypes.c_int(level), ctypes.c_void_p(out.ctypes.data))
        return out

    def save(self, path: Any, format: str = "auto", zstd: int = 0, *,
             context: Optional[Context] = None) -> SaveReport:
        """Writes the map to one or more files; the ending of the path decides which.

        path    .ktx2 or .dds for a cube with all levels; .exr, .hdr, .png or a folder for one file a face and level,
                whose name has {face} and {level} in it
        format  "auto", "rgba16f", "rgba32f", "rgb9e5", "b10g11r11", "bc6h", "rgbm", "rgbd", "rgbp"
                or "uastc"
        zstd    compression level of a KTX2 file, 1 to 22; 0 for none
        """
        report = c.kiln_save_report()
        definition = fill(c.kiln_save_def, format=format, zstd=zstd)
        with borrow(context) as used:
            used.run("kiln_map_save", self.checked(), out_path(path), ctypes.byref(definition), ctypes.byref(report))
        return save_report(report, path)

    def encode(self, name: str, format: str = "auto", zstd: int = 0, *,
               context: Optional[Context] = None) -> Dict[str, bytes]:
        """The files that save would write, by name."""
        files, report = c.kiln_files(), c.kiln_save_report()
        definition = fill(c.kiln_save_def, format=format, zstd=zstd)
        with borrow(context) as used:
            used.run("kiln_map_encode", self.checked(), path_bytes(name), ctypes.byref(definition),
                     ctypes.byref(files), ctypes.byref(report))
        save_report(report, name)
        return take_files(files)


Source = Union[str, os.PathLike, bytes, np.ndarray, Map, Sequence[str]]


def _shape_of(array: np.ndarray) -> str:
    for shape in ("cube", "panorama", "octahedron"):
        if array.ndim >= 3 and array.shape == level_shape(shape, array.shape[-3]) and array.shape[-3] > 0:
            return shape
    raise ArgumentError("an array of the shape %s is no level: (n, 2n, 3) is a panorama, (6, n, n, 3) a cube, "
                        "(n, n, 3) an octahedron" % (array.shape,))


def own_map(struct: Any, notes: List[Note], memory: Any = None) -> Map:
    """A Map on memory of the library: of the map itself, or of `memory` that the map is a part of."""
    memory = memory or Memory(struct, "kiln_map_free")
    made = Map.__new__(Map)
    shape = word("kiln_shape", struct.shape)
    sizes = [library.kiln_map_level_size(ctypes.byref(struct), k) for k in range(struct.level_count)]
    made._take(struct, [memory.array(struct.level[k], level_shape(shape, n)) for k, n in enumerate(sizes)], notes,
               memory)
    return made


def out_path(path: Any) -> bytes:
    """A path to write to. A folder that is there needs no final slash."""
    text = path_bytes(path)
    return text + b"/" if os.path.isdir(text) and not text.endswith(b"/") else text


def save_report(report: Any, path: Any) -> SaveReport:
    made: SaveReport = record(SaveReport, report)
    if made.cut_count:
        warnings.warn("%s: %d values above %g (up to %.4g) were cut off, with %.3g %% of the light" % (
            os.fspath(path), made.cut_count, made.limit, made.largest, 100 * made.light_share),
            SourceWarning, stacklevel=3)
    return made


def take_files(files: Any) -> Dict[str, bytes]:
    """The files as bytes; frees the library's."""
    try:
        listed = ctypes.cast(files.file, ctypes.POINTER(c.kiln_file))
        return {os.fsdecode(listed[i].name): ctypes.string_at(listed[i].bytes, listed[i].size)
                for i in range(files.count)}
    finally:
        library.kiln_files_free(ctypes.byref(files))


# -------------------------------------------------------------------------------------------------------- reading


def notes_of(report: Any) -> List[Note]:
    notes, note = [], c.kiln_note()
    while library.kiln_load_report_note(ctypes.byref(report), len(notes), ctypes.byref(note)):
        notes.append(Note(word("kiln_note_kind", note.kind), note.warning, note.text.decode("utf-8", "replace")))
    return notes


def warn_of(notes: Sequence[Note], name: str, level: int) -> None:
    for note in notes:
        if note.warning:
            warnings.warn("%s: %s" % (name, note.text), SourceWarning, stacklevel=level)


def _pixels(array: np.ndarray, layout: str, negative: str, report: Any) -> Tuple[Any, np.ndarray]:
    """A kiln_pixels for an array, and the array that the pixels lie in."""
    if array.dtype.kind != "f":
        raise ArgumentError("an array of %s holds no radiance: decode it to linear floats, or pass the path of its "
                            "file" % array.dtype)
    if array.dtype not in (np.float16, np.float32):
        array = array.astype(np.float32)
    if array.ndim == 4 and array.shape[0] == FACES and array.shape[1] == array.shape[2]:
        array = np.ascontiguousarray(array).reshape(FACES * array.shape[1], array.shape[2], array.shape[3])
        layout = "strip" if layout == "auto" else layout
    if array.ndim != 3 or array.shape[2] not in (3, 4):
        raise ArgumentError("an array of the shape %s is no picture: it must be (height, width, 3 or 4), or "
                            "(6, n, n, 3 or 4) for a cube" % (array.shape,))
    if array.strides[1:] != (array.shape[2] * array.itemsize, array.itemsize) or not array.dtype.isnative:
        array = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))
    pixels = fill(c.kiln_pixels, width=array.shape[1], height=array.shape[0], channels=array.shape[2],
                  type="half" if array.dtype == np.float16 else "float", layout=layout, negative=negative)
    pixels.data = array.ctypes.data
    pixels.row_stride = array.strides[0]
    pixels.report = ctypes.pointer(report)
    return pixels, array


def read_source(source: Source, used: Context, layout: str, negative: str, layer: Optional[str],
                progress: Optional[Progress], level: int) -> Map:
    """A map from whatever a function of this package takes as its source."""
    if isinstance(source, Map):
        return source
    struct, report = c.kiln_map(), c.kiln_load_report()
    name = "array"
    if isinstance(source, np.ndarray):
        pixels, kept = _pixels(source, layout, negative, report)
        used.run("kiln_map_from_pixels", ctypes.byref(pixels), ctypes.byref(struct), progress=progress)
        del kept
    else:
        options = fill(c.kiln_load_def, layout=layout, negative=negative,
                       layer=layer.encode() if layer is not None else None)
        options.report = ctypes.pointer(report)
        given = ctypes.byref(options), ctypes.byref(struct)
        if isinstance(source, bytes):
            name = "bytes"
            used.run("kiln_map_decode", source, len(source), b"bytes", *given, progress=progress)
        elif isinstance(source, (str, os.PathLike)):
            name = os.fspath(source)
            used.run("kiln_map_load", path_bytes(source), *given, progress=progress)
        else:
            paths = [path_bytes(path) for path in source]
            if len(paths) != FACES:
                raise ArgumentError("%d files of faces, there must be %d" % (len(paths), FACES))
            name = os.fspath(source[0])
            used.run("kiln_map_load_faces", (ctypes.c_char_p * FACES)(*paths), *given, progress=progress)
    notes = notes_of(report)
    warn_of(notes, name, level + 1)
    made = own_map(struct, notes)
    made._report = report
    return made


def load(source: Source, *, layout: str = "auto", negative: str = "keep", layer: Optional[str] = None,
         progress: Optional[Progress] = None, context: Optional[Context] = None) -> Map:
    """Reads a map: a path, the bytes of a file, or six paths of cube faces.

    Files are EXR, Radiance HDR, PNG, JPEG (with gain maps), KTX2, DDS and KTX 1; a folder or a pattern with {face}
    names six of them. Values become linear radiance with Rec. 709 primaries.

    layout    how a flat picture lies on the sphere: "auto" (by its proportions), "panorama", "cross", "strip",
              "octahedron", "probe" (angular map) or "ball" (mirror ball)
    negative  "keep" or "zero": what becomes of negative values
    layer     layer of an EXR file with several layers
    """
    with borrow(context) as used:
        return read_source(source, used, layout, negative, layer, progress, 3)


def from_array(array: np.ndarray, *, layout: str = "auto", negative: str = "keep",
               context: Optional[Context] = None) -> Map:
    """A map with a copy of an array: float16 or float32 (other floats are converted), of the shape (height, width,
    3 or 4), whose fourth channel is ignored, or (6, n, n, 3 or 4) for the faces +X -X +Y -Y +Z -Z of a cube.

    Values are linear radiance. Infinite values become 65504, values that are not a number the mean of their
    neighbours; the notes of the map count them. layout and negative are as for load.
    """
    with borrow(context) as used:
        return read_source(np.asarray(array), used, layout, negative, None, None, 3)


def sky(size: Optional[int] = None, elevation: Optional[float] = None, azimuth: float = 0.0,
        turbidity: Optional[float] = None, albedo: Optional[float] = None, *, context: Optional[Context] = None) -> Map:
    """A panorama of a daylight sky with its sun, in kcd/m^2 per channel.

    size       rows of the panorama, 16 to 8192; None for 512
    elevation  of the sun in degrees above the horizon, -5 to 90; None for 30
    azimuth    of the sun in degrees from -Z toward +X
    turbidity  haziness of the air, 1.7 (clear) to 10 (hazy); None for 3
    albedo     of the ground, 0 to 1; None for 0.2
    """
    definition = fill(c.kiln_sky_def, size=size, elevation=elevation, azimuth=azimuth, turbidity=turbidity,
                      albedo=albedo)
    struct = c.kiln_map()
    with borrow(context) as used:
        used.run("kiln_sky", ctypes.byref(definition), ctypes.byref(struct))
    return own_map(struct, [])


def convert(source: Source, shape: str, size: int, rotation: float = 0.0, *,
            context: Optional[Context] = None) -> Map:
    """Level 0 of a map in another shape or size. Each texel is the mean of the source over the texel's solid angle.

    shape     "panorama", "cube" or "octahedron"
    size      rows of a panorama, or texels along the edge of a face or an octahedron, 1 to 32768
    rotation  degrees about +Y, which move the content of a panorama to the left
    """
    struct = c.kiln_map()
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, None, 3)
        used.run("kiln_map_convert", read.checked(), number("kiln_shape", shape, "shape"),
                 integer(size, "size"), rotation, ctypes.byref(struct))
    return own_map(struct, read.notes)


class Layer(NamedTuple):
    """A layer of an EXR file."""

    part: str
    name: str
    channels: str
    picture: bool  #: True: kiln.load reads this layer unless the caller names another


class FileInfo(NamedTuple):
    """Description of a file, found without reading all of its texels."""

    format: str
    encoding: str
    layout: str
    width: int
    height: int
    depth: int
    face_count: int
    level_count: int
    channel_count: int
    byte_count: int
    roughness: List[float]  #: of each level; -1 where the file does not tell
    engine: str  #: name of the engine that the file is for, or empty
    writer: str
    orientation: str
    table: str
    sh: Optional[np.ndarray]  #: (bands * bands, 3) coefficients in the axes of the file, or None
    sh_irradiance: bool
    layers: List[Layer]
    notes: List[Note]


def describe(path: Any, *, context: Optional[Context] = None) -> FileInfo:
    """Describes any file that kiln reads or writes."""
    info = c.kiln_file_info()
    with borrow(context) as used:
        used.run("kiln_file_describe", path_bytes(path), ctypes.byref(info))
    values: Dict[str, Any] = {}
    for name, _ in c.kiln_file_info._fields_:
        value = getattr(info, name)
        values[name] = value.decode("utf-8", "replace") if isinstance(value, bytes) else value
    count = info.sh_bands * info.sh_bands
    values["sh"] = np.array(np.ctypeslib.as_array(info.sh)[:count]) if count else None
    values["roughness"] = list(info.roughness[:info.level_count])
    values["notes"] = notes_of(info.report)
    values["layers"] = [Layer(a.part.decode(), a.name.decode(), a.channels.decode(), a.picture)
                        for a in info.layer[:min(info.layer_count, c.KILN_MAX_LAYERS)]]
    return FileInfo(**{name: values[name] for name in FileInfo._fields})


def lobe(kind: str, roughness: float) -> Any:
    """The library's lobe of a kind and a roughness."""
    alpha = roughness * roughness
    if kind == "ggx":
        return library.kiln_lobe_ggx(alpha)
    if kind == "lambert":
        return library.kiln_lobe_lambert()
    if kind == "charlie":
        return library.kiln_lobe_charlie(max(alpha, 0.01))
    if kind == "phong":
        return library.kiln_lobe_phong(max(2 / max(alpha * alpha, 1e-12) - 2, 1))
    raise ArgumentError("lobe is %r, it must be one of ggx, lambert, charlie, phong" % (kind,))


def reference(source: Source, roughness: float, directions: ArrayLike, *, lobe_kind: str = "ggx",
              rotation: float = 0.0, progress: Optional[Progress] = None,
              context: Optional[Context] = None) -> np.ndarray:
    """Filtered radiance in some directions, by brute force over every texel of a panorama in float64.

    directions  unit vectors, (..., 3)
    lobe_kind   "ggx", "lambert", "charlie" or "phong", of this roughness in [0, 1]
    Returns float64 of the shape (..., 3). The relative error is at most 1e-6. For tests: the cost is the number of
    texels times the number of directions.
    """
    shape, (rows,) = broadcast([(directions, 3)])
    values = np.empty_like(rows)
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, progress, 3)
        used.run("kiln_reference_filter", read.checked(), ctypes.byref(lobe(lobe_kind, roughness)), rotation,
                 ctypes.c_void_p(rows.ctypes.data), len(rows), ctypes.c_void_p(values.ctypes.data), progress=progress)
    return values.reshape(shape + (3,))

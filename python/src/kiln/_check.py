"""Whether levels, harmonics and tables that any tool made are right: their errors, and what is wrong, in words."""

import ctypes
from typing import Any, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _header as c
from ._bake import Engine, Harmonics, engine
from ._library import Context, Progress, borrow, fill, library, path_bytes, record, word
from ._maps import Map, Source, own_map, read_source


class Finding(NamedTuple):
    """Something that a check recognised."""

    kind: str  #: what the finding is about: axes, mapping, brightness, shift, clamped, seam, firefly, negative, ...
    fault: bool  #: True: something is wrong; False: something to know
    text: str  #: a sentence without a capital and a full stop


class LevelReport(NamedTuple):
    """What is wrong with one level. Errors are relative: 0.01 is one per cent."""

    size: int  #: texels along the level's short side
    roughness: float  #: roughness with whose exact level the level was compared
    found: float  #: roughness whose exact level is most like the level; -1 where that cannot be told
    rms: float  #: root mean square difference from the exact level, divided by the root mean square of the exact level
    largest: float  #: largest difference, divided by the same
    bias: float  #: mean difference, divided by the mean of the exact level
    energy: float  #: root mean square of the level, divided by that of the exact level
    seam: float  #: root mean square of the jumps of the difference at edges of cube faces, divided as rms
    firefly_count: int  #: texels more than twice as bright as anything exact near them
    negative_count: int  #: texels with a channel below zero


class LevelsReport(NamedTuple):
    """What is wrong with levels."""

    levels: List[LevelReport]
    worst: float  #: largest rms of a level
    axis: Tuple[int, int, int]  #: with sign: the file shows at e the light from d, where d[i] = sign[i] e[axis[i]]
    sign: Tuple[int, int, int]
    brightness: float  #: factor by which all values are too bright, which the errors leave out
    findings: List[Finding]
    difference: Map  #: the levels minus the exact levels, in the panorama's directions

    @property
    def faults(self) -> List[str]:
        """The sentences about what is wrong; none if the levels are right."""
        return faults_of(self.findings)


class ShownReport(NamedTuple):
    """How right what an engine shows of levels is, relative to brute force."""

    rms: np.ndarray  #: of the roughnesses 0.1, 0.15, ... 1
    all: float  #: root mean square of rms
    worst: float  #: largest of rms
    worst_roughness: float
    direction_count: int
    displayed: float  #: root mean square difference of x / (x + mean), for values x and the mean of the source
    exact_all: float  #: what all would be of exact levels of the same sizes and roughness
    exact_displayed: float  #: what displayed would be of these


class HarmonicsReport(NamedTuple):
    """What is wrong with spherical harmonics."""

    band: List[float]  #: factor of each band, 1 where the band is right
    rms: float  #: norm of the difference from the exact coefficients, divided by the norm of these
    axis: Tuple[int, int, int]  #: as in LevelsReport
    sign: Tuple[int, int, int]
    findings: List[Finding]

    @property
    def faults(self) -> List[str]:
        """The sentences about what is wrong; none if the harmonics are right."""
        return faults_of(self.findings)


class TableReport(NamedTuple):
    """What is wrong with a table of a reflection model."""

    content: List[str]  #: what each channel holds: a, b, e, complement, sheen, zero, one or unknown
    d: str  #: distribution of normals of the model
    g: str  #: masking of the model
    axis: str  #: how n.v depends on the column
    corners: bool  #: True: texel i of n lies at i / (n - 1); False: at (i + 1/2) / n
    rms: float  #: root mean square difference from the exact values
    largest: float  #: largest difference
    findings: List[Finding]

    @property
    def faults(self) -> List[str]:
        """The sentences about what is wrong; none if the table is right."""
        return faults_of(self.findings)


def faults_of(findings: List[Finding]) -> List[str]:
    return [finding.text for finding in findings if finding.fault]


def findings_of(struct: Any) -> List[Finding]:
    return [Finding(word("kiln_finding_kind", a.kind), a.fault, a.text.decode("utf-8", "replace"))
            for a in struct.finding[:struct.count]]


def _pointer(of: Union[str, Engine, None]) -> Any:
    return None if of is None else engine(of)._pointer


def load_levels(path: Any, engine: Union[str, Engine, None] = None, *, context: Optional[Context] = None) -> Map:
    """Reads all levels of a prefiltered environment, whoever wrote it, in the axes of the file.

    path    a cube in a KTX, KTX2 or DDS file; an .env file of Babylon.js or of Galacean Engine; a .glb file with a
            light; an atlas of three.js or PlayCanvas; a path with {level} in it; or a folder of Filament's cmgen
    engine  the engine whose atlas a flat picture is; None for files that state their engine
    The roughness of a level is -1 where the file does not state the roughness.
    """
    struct = c.kiln_map()
    with borrow(context) as used:
        used.run("kiln_levels_load", path_bytes(path), _pointer(engine), None, ctypes.byref(struct))
    return own_map(struct, [])


def _levels(levels: Any, engine: Union[str, Engine, None], used: Context) -> Map:
    return levels if isinstance(levels, Map) else load_levels(levels, engine, context=used)


def check(source: Source, levels: Any, engine: Union[str, Engine, None] = None, *, lobe: str = "ggx",
          progress: Optional[Progress] = None, context: Optional[Context] = None) -> LevelsReport:
    """Compares prefiltered levels with exactly filtered levels of `source`: `kiln check`.

    source  the environment that the levels were made of, as for kiln.bake
    levels  a path, as for load_levels, or a Map in the axes of its file
    engine  the engine that the levels are for; None: axes are found, and the roughness is that of the file or found
    lobe    "ggx", "lambert", "charlie" or "phong"
    docs/check.md explains the numbers and how each fault is recognised.
    """
    report, difference = c.kiln_check_levels_report(), c.kiln_map()
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, progress, 3)
        given = _levels(levels, engine, used)
        definition = fill(c.kiln_check_levels_def, lobe=lobe)
        definition.stated = engine is None and bool(given.roughness[0] >= 0)
        if engine is not None:
            definition.engine = _pointer(engine)
        used.run("kiln_check_levels", read.checked(), given.checked(), ctypes.byref(definition),
                 ctypes.byref(report), ctypes.byref(difference), progress=progress)
    rows = [record(LevelReport, report.level[k]) for k in range(report.level_count)]
    return LevelsReport(rows, report.worst, tuple(report.axis), tuple(report.sign), report.brightness,
                        findings_of(report.findings), own_map(difference, []))


def check_shown(source: Source, levels: Any, engine: Union[str, Engine], *, progress: Optional[Progress] = None,
                context: Optional[Context] = None) -> ShownReport:
    """Compares what an engine shows of levels in its own axes with brute force. The arguments are as for check."""
    report = c.kiln_check_shown_report()
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, progress, 3)
        given = _levels(levels, engine, used)
        used.run("kiln_check_shown", read.checked(), given.checked(), _pointer(engine), ctypes.byref(report),
                 progress=progress)
    return ShownReport(np.array(report.rms), report.all, report.worst, report.worst_roughness, report.direction_count,
                       report.displayed, report.exact_all, report.exact_displayed)


def check_harmonics(source: Source, harmonics: Harmonics, engine: Union[str, Engine, None] = None, *,
                    context: Optional[Context] = None) -> HarmonicsReport:
    """Compares spherical harmonics, in the axes of their file, with those of `source`. What the harmonics claim to
    hold is their `irradiance` and `window`. `engine` is the engine whose axes are expected."""
    report = c.kiln_check_sh_report()
    with borrow(context) as used:
        read = read_source(source, used, "auto", "keep", None, None, 3)
        used.run("kiln_check_sh", read.checked(), ctypes.byref(harmonics.struct()), _pointer(engine),
                 ctypes.byref(report))
    return HarmonicsReport(list(report.band[:report.bands]), report.rms, tuple(report.axis), tuple(report.sign),
                           findings_of(report.findings))


def check_table(path: Any, *, context: Optional[Context] = None) -> TableReport:
    """Compares a table of any tool with exact integrals. The file is a texture or a picture: .ktx2, .exr, .hdr or
    .png. The order that is expected is that of kiln.table."""
    image, flip, report = c.kiln_image(), ctypes.c_bool(), c.kiln_check_table_report()
    with borrow(context) as used:
        used.run("kiln_table_numbers_load", path_bytes(path), ctypes.byref(image), ctypes.byref(flip))
        try:
            used.run("kiln_check_table", ctypes.byref(image), flip, ctypes.byref(report))
        finally:
            library.kiln_image_free(ctypes.byref(image))
    return TableReport([word("kiln_table_content", report.content[i]) for i in range(report.channels)],
                       word("kiln_d", report.model.d), word("kiln_g", report.model.g),
                       word("kiln_axis", report.axis), report.corners, report.rms, report.largest,
                       findings_of(report.findings))

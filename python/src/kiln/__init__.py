"""kiln: exact image-based lighting on numpy arrays.

    import kiln
    kiln.bake("city.exr", "three").save("city.ktx2")

A panorama goes in, prefiltered radiance, irradiance and spherical harmonics come out: kiln.bake. kiln.table, kiln.fit
and kiln.brdf are what surfaces do to light. kiln.check says whether files that any tool made are right.

Texels are linear radiance with Rec. 709 primaries. Directions are right-handed with +Y up; the centre of a panorama
looks along -Z and has +X to its right. Cube faces come in the order +X -X +Y -Y +Z -Z. Roughness is perceptual:
alpha = roughness^2.
"""

from . import brdf
from ._bake import (Engine, Environment, EnvironmentReport, Harmonics, Light, bake, engine, engines, harmonics,
                    lights)
from ._check import (Finding, HarmonicsReport, LevelReport, LevelsReport, ShownReport, TableReport, check,
                     check_harmonics, check_shown, check_table, load_levels)
from ._library import (ArgumentError, CancelledError, Context, Error, FileError, FormatError, OutOfMemoryError,
                       SourceWarning, UnsupportedError)
from ._library import version as __version__
from ._maps import FileInfo, Layer, Map, Note, SaveReport, convert, describe, from_array, load, reference, sky
from ._tables import Fit, Table, Walk, fit, load_table, table, walk

__all__ = [
    "ArgumentError", "CancelledError", "Context", "Engine", "Environment", "EnvironmentReport", "Error", "FileError",
    "FileInfo", "Finding", "Fit", "FormatError", "Harmonics", "HarmonicsReport", "Layer", "LevelReport",
    "LevelsReport", "Light", "Map", "Note", "OutOfMemoryError", "SaveReport", "ShownReport", "SourceWarning",
    "Table", "TableReport", "UnsupportedError", "Walk", "__version__", "bake", "brdf", "check", "check_harmonics",
    "check_shown", "check_table", "convert", "describe", "engine", "engines", "fit", "from_array", "harmonics",
    "lights", "load", "load_levels", "load_table", "reference", "sky", "table", "walk",
]

"""The files that Python writes are those of the command, byte for byte.

files.py KILN FOLDER ZSTD: KILN is the command, FOLDER holds the package, ZSTD is ON if the build has zstd. Each case
runs the command and the package with the same options and compares all files that either wrote.
"""
import os
import subprocess
import sys
import tempfile
import warnings

KILN, FOLDER, ZSTD = os.path.abspath(sys.argv[1]), sys.argv[2], sys.argv[3]
sys.path.insert(0, os.path.abspath(FOLDER))

import numpy as np  # noqa: E402

import kiln  # noqa: E402

# Of each case: the input, the command's options, bake's options, and what save writes.
CASES = [
    ("a.exr", "--size 32 -o out.ktx2", {"size": 32}, ("out.ktx2", {})),
    ("a.exr", "--size 16 -o out.dds --format b10g11r11 --roughness 0,0.25,0.5,1",
     {"size": 16, "roughness": [0, .25, .5, 1]}, ("out.dds", {"format": "b10g11r11"})),
    ("a.hdr", "--size 16 -o out.ktx2 --irradiance d.ktx2 --irradiance-size 8 --sh sh.json --sh-bands 4 --sh-window 5",
     {"size": 16, "irradiance_size": 8, "sh_bands": 4},
     ("out.ktx2", {"irradiance": "d.ktx2", "sh": "sh.json", "sh_window": 5})),
    ("a.exr", "--size 16 -o out/{face}_{level}.exr --mirror --exposure 1.5 --rotate 30,20,10",
     {"size": 16, "mirror": True, "exposure": 1.5, "rotation": 30, "pitch": 20, "roll": 10},
     ("out/{face}_{level}.exr", {})),
    ("a.exr", "--size 16 -o p_%d.hdr --shape panorama --lobe charlie --levels 2 --roughness 0.5,1 --up z",
     {"size": 16, "shape": "panorama", "lobe": "charlie", "roughness": [.5, 1], "up": "z"}, ("p_%d.hdr", {})),
    ("a.exr", "--size 16 -o out.ktx2 --sun extract --lights 2 --lights-share 0.001 --lights-file l.json",
     {"size": 16, "sun": "extract", "light_count": 2, "light_share": .001}, ("out.ktx2", {"lights": "l.json"})),
    ("a.exr", "--size 16 -o out.ktx2 --sun clamp=5 --format rgb9e5 --levels 3",
     {"size": 16, "sun": "clamp", "clamp": 5, "level_count": 3}, ("out.ktx2", {"format": "rgb9e5"})),
    ("a.exr", "--for three --size 16 -o out.ktx2", {"engine": "three", "size": 16}, ("out.ktx2", {})),
    ("a.exr", "--for three --size 32 --tune none -o out.ktx2", {"engine": "three", "size": 32, "tune": "none"},
     ("out.ktx2", {})),
    ("a.exr", "--for filament --size 32 -o out --sh f.txt --sh-irradiance", {"engine": "filament", "size": 32},
     ("out", {"sh": "f.txt", "sh_irradiance": True})),
    ("a.exr", "--for babylon --size 32 --tune none -o out.env", {"engine": "babylon", "size": 32, "tune": "none"},
     ("out.env", {})),
    ("a.exr", "--for gltf --size 32 -o out.glb", {"engine": "gltf", "size": 32}, ("out.glb", {})),
    ("faces/{face}.png", "--size 8 -o out.ktx2 --lobe lambert --format bc6h",
     {"size": 8, "lobe": "lambert", "level_count": 1}, ("out.ktx2", {"format": "bc6h"})),
    ("square.exr", "--layout probe --negative zero --size 8 -o out.ktx2",
     {"layout": "probe", "negative": "zero", "size": 8}, ("out.ktx2", {})),
]
if ZSTD == "ON":
    CASES.append(("a.exr", "--size 16 -o out.ktx2 --zstd=5", {"size": 16}, ("out.ktx2", {"zstd": 5})))


def inputs() -> None:
    """Random radiance with a bright sun and negative values, and the faces of a cube."""
    random = np.random.default_rng(4)
    panorama = random.gamma(.5, size=(16, 32, 3)).astype(np.float32)
    panorama[5, 7] = 3000
    panorama[12, 1] = -.25
    kiln.Map(panorama).save("a.exr", "rgba32f")
    kiln.Map(np.abs(panorama)).save("a.hdr")
    kiln.Map(random.normal(.5, size=(16, 16, 3)).astype(np.float32)).save("square.exr", "rgba32f")
    os.mkdir("faces")
    kiln.Map(random.uniform(size=(6, 8, 8, 3)).astype(np.float32)).save("faces/{face}.png")


def contents(folder: str) -> dict:
    found = {}
    for where, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(where, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def compare(number: int, source: str, options: str, bake: dict, save: tuple) -> int:
    by_command, by_python = "c%d" % number, "p%d" % number
    source = os.path.abspath(source)
    for folder in (by_command, by_python):
        os.makedirs(os.path.join(folder, "out") if "out/" in options else folder)
    subprocess.check_call([KILN, "bake", source, *options.split(), "-q"], cwd=by_command)
    home = os.getcwd()
    os.chdir(by_python)
    kiln.bake(source, **bake).save(save[0], **save[1])
    os.chdir(home)
    wanted, got = contents(by_command), contents(by_python)
    assert wanted and sorted(wanted) == sorted(got), "%s: %s and %s" % (options, sorted(wanted), sorted(got))
    for name, data in wanted.items():
        assert data == got[name], "%s: %s differs" % (options, name)
    return len(wanted)


def tables() -> int:
    subprocess.check_call([KILN, "tables", "--table", "dfg", "--axis", "sqrt", "--corners", "--size", "16",
                           "-o", "c.ktx2", "-q"])
    kiln.table("dfg", width=16, height=16, axis="sqrt", corners=True).save("p.ktx2")
    subprocess.check_call([KILN, "sky", "--size", "16", "--elevation", "10", "-o", "c.exr", "-q"])
    kiln.sky(16, elevation=10).save("p.exr", "rgba32f")
    for name in ("ktx2", "exr"):
        with open("c." + name, "rb") as a, open("p." + name, "rb") as b:
            assert a.read() == b.read(), "%s differs" % name
    return 2


def encoded() -> int:
    """encode returns what save writes."""
    made = kiln.bake("a.exr", size=8)
    files = made.encode("e.ktx2", irradiance="i.exr", sh="s.json")
    os.mkdir("e")
    os.chdir("e")
    made.save("e.ktx2", irradiance="i.exr", sh="s.json")
    assert files == contents(".") and len(files) == 8, sorted(files)
    os.chdir("..")
    return len(files)


with tempfile.TemporaryDirectory() as work, warnings.catch_warnings():
    warnings.simplefilter("ignore")
    os.chdir(work)
    inputs()
    count = sum(compare(i, *case) for i, case in enumerate(CASES)) + tables() + encoded()
    os.chdir("/")
    print("%d bakes, %d files" % (len(CASES), count))

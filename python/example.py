# %% [markdown]
# Draws what kiln bakes as PNG files: a panorama, its prefiltered levels, a ball lit by its harmonics, and a table.
# Run it whole, python3 example.py [PANORAMA] [FOLDER], or cell by cell in an editor that knows "# %%".

# %% The package, and a panorama: a file, or a sky
import os
import struct
import sys
import zlib

import numpy as np

import kiln

folder = sys.argv[2] if len(sys.argv) > 2 else "pictures"
os.makedirs(folder, exist_ok=True)
source = kiln.load(sys.argv[1]) if len(sys.argv) > 1 else kiln.sky(256, elevation=35, azimuth=120)
source = kiln.convert(source, "panorama", 128)


# %% A picture of radiance: exposed such that the mean is a medium grey, with the sRGB curve, as PNG
def show(name: str, radiance: np.ndarray, exposure: float = 0.18 / float(source.levels[0].mean())) -> None:
    x = np.clip(radiance * exposure, 0, 1)
    x = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    pixels = (255 * x + 0.5).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path = os.path.join(folder, name)
    with open(path, "wb") as file:
        size = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0)
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(rows)))
        file.write(chunk(b"IEND", b""))
    print(path, "%d x %d" % pixels.shape[1::-1])


show("panorama.png", source.levels[0])

# %% Prefiltered panoramas, one below the other: roughness 0 (a mirror), 0.25, 0.5 and 1
made = kiln.bake(source, size=128, shape="panorama", roughness=[0, 0.25, 0.5, 1])
rows = [level.repeat(128 // len(level), axis=0).repeat(128 // len(level), axis=1) for level in made.levels]
show("levels.png", np.concatenate(rows))

# %% A white diffuse ball, lit by nine coefficients, seen from +Z
y, x = np.mgrid[1:-1:256j, -1:1:256j]
inside = x * x + y * y < 1
z = np.sqrt(np.where(inside, 1 - x * x - y * y, 0))
normals = np.stack([x, y, z], axis=-1)
normals[~inside] = 0, 1, 0
ball = made.sh.filter(irradiance=True).evaluate(normals) / np.pi
show("ball.png", np.where(inside[..., None], ball, 0))

# %% The split-sum table: red is A, green is B, so that the albedo is F0 A + B; n.v to the right, roughness upwards
nov, roughness = np.meshgrid((np.arange(256) + 0.5) / 256, 1 - (np.arange(256) + 0.5) / 256)
ab = kiln.table("dfg", axis="sqrt", corners=True, width=64, height=64).lookup(nov, roughness)
show("split-sum.png", np.concatenate([ab, np.zeros(ab.shape[:2] + (1,))], axis=-1), 1)

# %% The files that an engine loads, without the sun, which becomes a light of the engine's own
lit = kiln.bake(source, "bevy", 128, sun="extract")
report = lit.save(os.path.join(folder, "sky"))
print("%d files, %d values cut off" % (report.file_count, report.levels.cut_count), lit.lights)

"""kiln in Python: values of known environments and integrals, shapes, exceptions, threads and Control-C.

package.py FOLDER: FOLDER holds the package `kiln` of a build.
"""
import gc
import os
import signal
import sys
import tempfile
import threading
import time
import unittest
import warnings

sys.path.insert(0, sys.argv.pop(1))

import numpy as np  # noqa: E402

import kiln  # noqa: E402


def directions(count: int = 50) -> np.ndarray:
    d = np.random.default_rng(1).normal(size=(count, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def gradient(shape: str, size: int) -> kiln.Map:
    """Radiance (2 + y, 2 + x, 2 + z) at the centre of each texel."""
    levels = {"cube": (6, size, size, 3), "panorama": (size, 2 * size, 3), "octahedron": (size, size, 3)}
    made = kiln.Map(np.zeros(levels[shape], np.float32))
    made.levels[0][...] = (2 + made.directions()[..., [1, 0, 2]]).astype(np.float32)
    return made


class Bake(unittest.TestCase):
    def test_white(self) -> None:
        made = kiln.bake(np.full((16, 32, 3), 0.75), size=16)
        self.assertEqual([a.shape for a in made.levels], [(6, n, n, 3) for n in (16, 8, 4, 2, 1)])
        self.assertEqual(made.irradiance.shape, (6, 64, 64, 3))
        for level in made.levels + [made.irradiance]:
            self.assertEqual(level.dtype, np.float32)
            np.testing.assert_allclose(level, 0.75, rtol=2e-6)
        np.testing.assert_allclose(made.roughness, [0, .25, .5, .75, 1])
        # Y00 = 1 / sqrt(4 pi), so that the first coefficient is the radiance times sqrt(4 pi).
        self.assertEqual(made.sh.c.shape, (9, 3))
        np.testing.assert_allclose(made.sh.c[0], 0.75 * np.sqrt(4 * np.pi), rtol=1e-6)
        np.testing.assert_allclose(made.sh.c[1:], 0, atol=1e-6)

    def test_linear_radiance(self) -> None:
        # The cosine lobe leaves degree 1 with 2/3 of degree 0; irradiance / pi of 2 + y is 2 + 2 y / 3.
        for shape in ("panorama", "cube", "octahedron"):
            made = kiln.bake(gradient(shape, 32), size=8, irradiance_size=16)
            there = made.irradiance_map.directions()[..., [1, 0, 2]]
            np.testing.assert_allclose(made.irradiance, 2 + there * 2 / 3, atol=4e-3)
            d = directions()
            np.testing.assert_allclose(made.sh.evaluate(d), 2 + d[:, [1, 0, 2]], atol=4e-3)
            np.testing.assert_allclose(made.sh.filter(irradiance=True).evaluate(d),
                                       np.pi * (2 + d[:, [1, 0, 2]] * 2 / 3), atol=8e-3)

    def test_inputs_agree(self) -> None:
        sky = kiln.sky(16, elevation=40)
        wanted = kiln.bake(sky, size=8).levels
        pixels = sky.levels[0]
        four = np.concatenate([pixels, np.ones(pixels.shape[:2] + (1,), np.float32)], axis=2)
        upside_down = np.ascontiguousarray(pixels[::-1])[::-1]  # rows from the bottom up in memory
        self.assertLess(upside_down.strides[0], 0)
        for source in (pixels, four, four[..., :3], upside_down, pixels.astype(np.float64), pixels.astype(">f4"),
                       sky.encode("sky.exr", "rgba32f")["sky.exr"]):
            for got, want in zip(kiln.bake(source, size=8).levels, wanted):
                np.testing.assert_array_equal(got, want)
        cube = kiln.convert(sky, "cube", 8)
        for source in (cube.levels[0], np.concatenate([cube.levels[0]] + [cube.levels[0][..., :1]], axis=-1)):
            np.testing.assert_array_equal(kiln.from_array(source).levels[0], cube.levels[0])
        half = kiln.from_array(pixels.astype(np.float16))
        np.testing.assert_array_equal(half.levels[0], pixels.astype(np.float16).astype(np.float32))

    def test_options(self) -> None:
        sky = kiln.sky(16)
        plain = kiln.bake(sky, size=8)
        np.testing.assert_array_equal(kiln.bake(sky, size=8, exposure=1).levels[1], 2 * plain.levels[1])
        self.assertIsNone(kiln.bake(sky, size=8, irradiance_size=0).irradiance)
        self.assertEqual(kiln.bake(sky, size=8, roughness=[.5, .75]).roughness.tolist(), [.5, .75])
        self.assertEqual(kiln.bake(sky, size=8, shape="panorama").levels[0].shape, (8, 16, 3))
        self.assertEqual(kiln.bake(sky, size=8, sh_bands=5).sh.bands, 5)
        # A quarter turn about +Y moves the content of a panorama to the left by a quarter.
        turned = kiln.convert(sky, "panorama", 16, 90)
        np.testing.assert_allclose(turned.levels[0], np.roll(sky.levels[0], -8, axis=1), rtol=1e-6)
        dark = kiln.sky(16, elevation=0, albedo=0)  # 0 is a value, not the default
        self.assertEqual(float(np.abs(dark.levels[0][-1]).max()), 0)
        sky = kiln.sky(64)
        extracted = kiln.bake(sky, size=8, sun="extract")
        self.assertEqual(len(extracted.lights), 1)
        light = kiln.lights(sky)[0]
        self.assertEqual(extracted.lights[0], light)
        self.assertAlmostEqual(light.direction[1], .5, delta=.05)  # the sun stands at 30 degrees
        self.assertGreater(kiln.bake(sky, size=8, sun="clamp").clamped, 0)

    def test_reference(self) -> None:
        sky = kiln.sky(32)
        made = kiln.bake(sky, size=16, roughness=[0, .6])
        there = made.map.directions(1).reshape(-1, 3)[::97]
        wanted = kiln.reference(sky, .6, there)
        np.testing.assert_allclose(made.levels[1].reshape(-1, 3)[::97], wanted, rtol=2e-4)

    def test_engines(self) -> None:
        names = [e.name for e in kiln.engines()]
        self.assertIn("three", names)
        three = kiln.engine("three")
        made = kiln.bake(np.ones((16, 32, 3)), "three", tune="none", irradiance_size=0)
        self.assertEqual((made.map.size, len(made.levels)), (three.size, three.level_count))
        np.testing.assert_allclose(three.show(made.map, .5, directions()), 1, rtol=1e-3)
        levels = three.level(made.roughness)
        np.testing.assert_allclose(levels[1:], range(1, three.level_count), atol=1e-5)
        with tempfile.TemporaryDirectory() as folder:
            # The atlases of PlayCanvas and three.js and the files of Unity have 64 texels and more, and take longer.
            large = ("playcanvas", "playcanvas-dds", "three-cubeuv", "unity")
            for engine in (e for e in kiln.engines() if e.name not in large):
                name = engine.name
                report = kiln.bake(np.ones((16, 32, 3)), engine, 32, tune="none", irradiance_size=0).save(
                    os.path.join(folder, name + (engine.ending and "." + engine.ending)))
                self.assertGreater(report.file_count, 0, name)
                self.assertEqual(report.levels.cut_count, 0)

    def test_saved_edits(self) -> None:
        made = kiln.bake(np.ones((8, 16, 3)), size=4)
        made.levels[0][2, :, :, 0] = 5
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.ktx2")
            made.save(path, "rgba32f")
            again = kiln.load(path)
            np.testing.assert_array_equal(again.levels[0], made.levels[0])
            info = kiln.describe(path)
            self.assertEqual((info.layout, info.width, info.level_count), ("cube", 4, 3))
            np.testing.assert_allclose(info.sh, made.sh.c, rtol=1e-6, atol=1e-6)
            made.save(folder)  # a folder without a slash
            self.assertTrue(os.path.exists(os.path.join(folder, "px_0.exr")), os.listdir(folder))


class Harmonics(unittest.TestCase):
    def test_values(self) -> None:
        coefficients = np.random.default_rng(2).normal(size=(9, 3))
        x, y, z = directions().T
        basis = np.stack([np.full_like(x, .5 / np.sqrt(np.pi)), *(np.sqrt(.75 / np.pi) * v for v in (y, z, x)),
                          *(.5 * np.sqrt(15 / np.pi) * v for v in (x * y, y * z)),
                          .25 * np.sqrt(5 / np.pi) * (3 * z * z - 1), .5 * np.sqrt(15 / np.pi) * x * z,
                          .25 * np.sqrt(15 / np.pi) * (x * x - y * y)])
        got = kiln.Harmonics(coefficients).evaluate(directions())
        np.testing.assert_allclose(got, basis.T @ coefficients, rtol=1e-9, atol=1e-9)
        window = kiln.Harmonics(coefficients).filter(window=4)
        np.testing.assert_allclose(window.c[1:4], coefficients[1:4] * (1 + np.cos(np.pi / 4)) / 2)
        self.assertEqual(kiln.Harmonics(coefficients).filter(2).bands, 2)
        with self.assertRaises(kiln.ArgumentError):
            kiln.Harmonics(np.zeros((8, 3)))


class Brdf(unittest.TestCase):
    def test_formulas(self) -> None:
        r, v, l, h = np.random.default_rng(3).uniform(.05, 1, (4, 100))
        a2 = r ** 4
        np.testing.assert_allclose(kiln.brdf.d(r, h), a2 / (np.pi * (h * h * (a2 - 1) + 1) ** 2), rtol=1e-9)
        g = 2 * v * l / (l * np.sqrt(a2 + (1 - a2) * v * v) + v * np.sqrt(a2 + (1 - a2) * l * l))
        np.testing.assert_allclose(kiln.brdf.g(r, v, l), g, rtol=1e-9)
        np.testing.assert_allclose(kiln.brdf.specular(r, v, l, h),
                                   kiln.brdf.d(r, h) * g / (4 * v * l), rtol=1e-9)
        np.testing.assert_allclose(kiln.brdf.fresnel_schlick(.04, v), .04 + .96 * (1 - v) ** 5)
        k = r * r / 2
        np.testing.assert_allclose(kiln.brdf.g(r, v, l, g="schlick-k2"),
                                   v / (v * (1 - k) + k) * l / (l * (1 - k) + k), rtol=1e-9)
        f0 = ((1.5 - 1) / (1.5 + 1)) ** 2
        self.assertAlmostEqual(float(kiln.brdf.fresnel_dielectric(1.5, 1)), f0, places=12)
        n, k = kiln.brdf.gulbrandsen(.7, .3)
        self.assertAlmostEqual(float(kiln.brdf.fresnel_conductor(n, k, 1)), .7, places=10)

    def test_integrals(self) -> None:
        # E by two-dimensional brute force in 25-digit arithmetic, as in tests/cli/eval.sh.
        roughness, nov = [.05, .25, .5, .75, 1], [.01, .1, .5, .5, .1]
        known = {"smith": [.9645480233, .8967696353, .8572634356, .6631758453, .7602104727],
                 "schlick-k2": [.7928232340, .6823584692, .7470809150, .5799818067, .5579142172]}
        for g, wanted in known.items():
            np.testing.assert_allclose(kiln.brdf.energy(roughness, nov, g=g), wanted, atol=5.1e-11)
        ab = kiln.brdf.energy_split(roughness, nov)
        self.assertEqual(ab.shape, (5, 2))
        np.testing.assert_allclose(ab.sum(axis=1), known["smith"], atol=2e-10)
        rt = kiln.brdf.glass(.3, 1.5, [[.2], [.8]])
        self.assertEqual(rt.shape, (2, 1, 2))
        self.assertTrue((rt.sum(axis=-1) < 1).all() and (rt.sum(axis=-1) > .9).all())

    def test_shapes(self) -> None:
        self.assertEqual(kiln.brdf.energy(.5, .5).shape, ())
        self.assertEqual(kiln.brdf.fresnel_schlick(np.zeros((3, 1)), np.zeros(4)).shape, (3, 4))
        self.assertEqual(kiln.brdf.fresnel_schlick(np.zeros((0, 3)), .5).shape, (0, 3))
        # More than one piece of the loop, and arrays that are not contiguous.
        f0 = np.linspace(0, 1, 5000)[::2]
        np.testing.assert_allclose(kiln.brdf.fresnel_schlick(f0, .5), f0 + (1 - f0) / 32)
        v = np.array([[0, 0, 1.], [.6, 0, .8]])
        h = kiln.brdf.sample_visible(.4, v, np.full((7, 1, 2), .3))
        self.assertEqual(h.shape, (7, 2, 3))
        np.testing.assert_allclose(np.linalg.norm(h, axis=-1), 1)
        for bad in (lambda: kiln.brdf.energy(np.zeros(3), np.zeros(4)), lambda: kiln.brdf.energy(.5, .5, g="x"),
                    lambda: kiln.brdf.sample_cosine([.1, .2, .3])):
            with self.assertRaises(kiln.ArgumentError):
                bad()

    def test_samplers_match_their_densities(self) -> None:
        # The mean of f / density over samples is the integral of f: here n.h = 1 over D (n.h).
        xi = (np.stack(np.meshgrid(np.arange(64), np.arange(64)), -1) + .5) / 64
        h = kiln.brdf.sample_half_vector(.6, xi)
        weight = h[..., 2] ** 2 / kiln.brdf.pdf_half_vector(.6, h[..., 2])
        inside = kiln.brdf.pdf_half_vector(.6, h[..., 2]) > 0
        self.assertTrue(inside.all())
        self.assertAlmostEqual(float(weight.mean()), 2 * np.pi / 3, delta=.02)

    def test_walk(self) -> None:
        walk = kiln.walk([.3, .8], .5, fresnel="constant", f0=1, path_count=4096)
        np.testing.assert_allclose(walk.albedo, 1, rtol=1e-12)
        self.assertEqual(walk.bounce.shape, (2, 16))
        np.testing.assert_allclose(walk.bounce[:, 0], kiln.brdf.energy([.3, .8], .5), atol=.02)


class Tables(unittest.TestCase):
    def test_tables(self) -> None:
        made = kiln.table("dfg", width=16, height=8, axis="sqrt", corners=True)
        self.assertEqual((made.texels.shape, made.kind, made.axis), ((8, 16, 2), "dfg", "sqrt"))
        nov, roughness, _ = made.coordinates()
        np.testing.assert_allclose(nov[0], (np.arange(16) / 15) ** 2)
        np.testing.assert_allclose(roughness[:, 0], np.arange(8) / 7)
        np.testing.assert_allclose(made.texels, kiln.brdf.energy_split(roughness, nov), atol=1e-6)
        # Bilinear between four texels, at the middle of a cell in u = sqrt(n.v) and v.
        middle = made.texels[2:4, 4:6].mean(axis=(0, 1))
        np.testing.assert_allclose(made.lookup((4.5 / 15) ** 2, 2.5 / 7), middle, rtol=1e-6)
        solid = kiln.table("e-dielectric", width=4, height=3, depth=2)
        self.assertEqual(solid.texels.shape, (2, 3, 4, 1))
        self.assertEqual(solid.lookup(np.zeros((5, 1)), np.zeros(2), 1.5).shape, (5, 2))
        lobes = kiln.table("lobes", width=5, height=4, tap_count=2, level_roughness=(0, 0.5, 1))
        self.assertEqual((lobes.texels.shape, lobes.tap_count, lobes.level_roughness), ((3, 4, 5, 4), 2, (0, 0.5, 1)))
        np.testing.assert_array_less(-1e-9, lobes.texels[:2, :, :, 2])
        np.testing.assert_allclose(lobes.lookup(0.25, 1 / 3), lobes.texels[:, 1, 1].ravel(), rtol=1e-6)
        average = kiln.table("e", width=32, height=32).average(16)
        self.assertEqual(average.kind, "eavg")
        self.assertAlmostEqual(float(average.texels[15, 0, 0]), float(kiln.brdf.energy_average(15.5 / 16)), delta=1e-3)
        with tempfile.TemporaryDirectory() as folder:
            made.save(os.path.join(folder, "t.ktx2"), "f32")
            np.testing.assert_array_equal(kiln.load_table(os.path.join(folder, "t.ktx2")).texels, made.texels)
            made.save_lookup(os.path.join(folder, "t.glsl"))

    def test_fit(self) -> None:
        made = kiln.fit("e-average", error=1e-3)
        r = np.linspace(0, 1, 33)
        np.testing.assert_allclose(made.evaluate(0, r), kiln.brdf.energy_average(r), atol=1e-3)
        self.assertLessEqual(made.max_error, 1e-3)


class Failures(unittest.TestCase):
    def test_sentences(self) -> None:
        white = np.ones((4, 8, 3))
        for call, kind, base, sentence in (
                (lambda: kiln.load("nix.exr"), kiln.FileError, OSError, "nix.exr: cannot be opened: No such file"),
                (lambda: kiln.load(b"abc"), kiln.FormatError, ValueError, "bytes: its 3 bytes do not begin like"),
                (lambda: kiln.bake(white, size=-3), kiln.ArgumentError, ValueError,
                 "size is -3, it must be 1 to 32768"),
                (lambda: kiln.bake(white, size=2**40), kiln.ArgumentError, ValueError, "size is 1099511627776"),
                (lambda: kiln.bake(white, "foo"), kiln.ArgumentError, ValueError,
                 "engine is 'foo', it must be one of three,"),
                (lambda: kiln.bake(white, lobe="x"), kiln.ArgumentError, ValueError, "lobe is 'x', it must be one of"),
                (lambda: kiln.bake(white, lobe="custom"), kiln.ArgumentError, ValueError, ""),
                (lambda: kiln.bake(white.astype(np.uint8)), kiln.ArgumentError, ValueError, "an array of uint8"),
                (lambda: kiln.bake(np.ones((4, 8))), kiln.ArgumentError, ValueError, "(4, 8) is no picture"),
                (lambda: kiln.bake(np.full((4, 8, 3), np.nan)), kiln.ArgumentError, ValueError,
                 "all of its 32 texels are infinite or not a number"),
                (lambda: kiln.bake(white, "three", roughness=[0, 1]), kiln.ArgumentError, ValueError, ""),
                (lambda: kiln.bake(white, roughness=[0, 1], level_count=3), kiln.ArgumentError, ValueError,
                 "roughness has 2 numbers, but level_count is 3"),
                (lambda: kiln.bake(white, size=1024, context=kiln.Context(1, memory_limit=100000)),
                 kiln.OutOfMemoryError, MemoryError, ""),
                (lambda: kiln.bake(white, size=4).save("x.tiff"), kiln.Error, Exception, "x.tiff"),
                (lambda: kiln.bake(white, size=4).save("a\0b.ktx2"), kiln.ArgumentError, ValueError, "NUL"),
                (lambda: kiln.bake(white, progress=lambda stage, part: False), kiln.CancelledError, Exception,
                 "stopped"),
                (lambda: kiln.load(["a.png"] * 5), kiln.ArgumentError, ValueError, "5 files of faces"),
                (lambda: kiln.Context(threads=1000), kiln.ArgumentError, ValueError, "1000")):
            with self.assertRaises(kind) as caught:
                call()
            self.assertIsInstance(caught.exception, (base,))
            self.assertIsInstance(caught.exception, kiln.Error)
            self.assertIn(sentence, str(caught.exception))

    def test_maps_are_checked(self) -> None:
        bad = np.ones((4, 8, 3), np.float32)
        bad[1, 1, 1] = np.inf
        with self.assertRaises(kiln.ArgumentError):
            kiln.bake(kiln.Map(bad))
        with self.assertRaises(kiln.ArgumentError):
            kiln.Map([np.ones((4, 8, 3), np.float32), np.ones((1, 2, 3), np.float32), np.ones((1, 2, 3), np.float32)])
        with self.assertRaises(kiln.ArgumentError):
            kiln.Map(np.ones((4, 8, 3)))  # float64 would be read as other numbers
        made = kiln.bake(np.ones((4, 8, 3)), size=4)
        made.levels[0] = made.levels[0].copy()
        with self.assertRaises(kiln.ArgumentError):
            made.encode("a.ktx2")

    def test_notes_and_warnings(self) -> None:
        pixels = np.ones((4, 8, 3), np.float32)
        pixels[1, 1, 1] = np.nan
        with self.assertWarnsRegex(kiln.SourceWarning, "1 of 32 texels is not a number"):
            made = kiln.from_array(pixels)
        self.assertEqual([(note.kind, note.warning) for note in made.notes], [("nan", True)])
        np.testing.assert_array_equal(made.levels[0], 1)
        bright = kiln.bake(np.full((4, 8, 3), 1e5), size=4, irradiance_size=0)
        with self.assertWarnsRegex(kiln.SourceWarning, "values above 65504"):
            bright.encode("a.ktx2")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            bright.encode("a.ktx2", "rgba32f")

    def test_exceptions_of_callbacks(self) -> None:
        def fails(stage: str, fraction: float) -> None:
            raise KeyError(stage)

        with self.assertRaises(KeyError):
            kiln.bake(kiln.sky(16), size=8, progress=fails)
        seen = []
        kiln.bake(kiln.sky(16), size=8, progress=lambda stage, fraction: seen.append((stage, fraction)))
        self.assertTrue(seen and all(0 <= fraction <= 1 for _, fraction in seen))


class Work(unittest.TestCase):
    def test_same_bits_for_any_threads(self) -> None:
        sky = kiln.sky(32)
        one = kiln.bake(sky, size=16, context=kiln.Context(1, cpu="scalar"))
        many = kiln.bake(sky, size=16, context=kiln.Context(5))
        for a, b in zip(one.levels, many.levels):
            np.testing.assert_array_equal(a, b)
        self.assertEqual(kiln.Context(3).threads, 3)
        self.assertEqual(kiln.Context(1, cpu="scalar").cpu, "scalar")

    def test_lock_is_released(self) -> None:
        # While this thread works in the library, another runs Python.
        count, done = [0], threading.Event()

        def run() -> None:
            while not done.is_set():
                count[0] += 1
                time.sleep(0)

        other = threading.Thread(target=run)
        other.start()
        seen = []
        try:
            started = time.monotonic()
            while not seen or seen[-1] < 20:
                before = count[0]
                kiln.brdf.energy_average(np.full(1000, .37))  # one call of the loop
                seen.append(count[0] - before)
                self.assertLess(time.monotonic() - started, 20, "no other thread ran: %s" % seen)
        finally:
            done.set()
            other.join()

    def test_python_threads(self) -> None:
        sky, results = kiln.sky(16), [None] * 4
        shared = kiln.Context(1)

        def run(i: int) -> None:
            results[i] = kiln.bake(sky, size=8, context=shared if i % 2 else None).levels

        threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results[1:]:
            for a, b in zip(results[0], result):
                np.testing.assert_array_equal(a, b)

    def test_control_c(self) -> None:
        started = time.monotonic()
        threading.Timer(.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            while time.monotonic() - started < 20:
                kiln.bake(kiln.sky(64), size=64)

    def test_fork(self) -> None:
        kiln.sky(16)
        child = os.fork()
        if child == 0:
            try:
                kiln.bake(kiln.sky(16), size=4)
                os._exit(0)
            finally:
                os._exit(1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_memory(self) -> None:
        context = kiln.Context(1)
        made = kiln.bake(np.ones((16, 32, 3)), size=16, context=context)
        level = made.levels[0]
        held = context.memory[0]
        self.assertGreater(held, level.nbytes)
        del made
        gc.collect()
        np.testing.assert_allclose(level, 1, rtol=1e-6)  # the array keeps its memory
        self.assertEqual(context.memory[0], held)
        del level
        gc.collect()
        self.assertEqual(context.memory[0], 0)


class Surface(unittest.TestCase):
    def test_documented_and_typed(self) -> None:
        import inspect
        import typing

        for module in (kiln, kiln.brdf):
            for name in module.__all__:
                thing = getattr(module, name)
                if not callable(thing):
                    continue
                self.assertTrue(thing.__doc__, name)
                if inspect.isfunction(thing):
                    hints = typing.get_type_hints(thing)
                    self.assertEqual(set(hints), set(inspect.signature(thing).parameters) | {"return"}, name)
                    self.assertNotIn("kiln_", thing.__doc__.replace("kiln_h", ""), name)


class Check(unittest.TestCase):
    """kiln.check says of right files that they are right, and names a planted fault."""

    source: kiln.Map

    @classmethod
    def setUpClass(cls) -> None:
        cls.source = kiln.Map(np.zeros((32, 64, 3), np.float32))
        there, random = cls.source.directions(), np.random.default_rng(3)
        cls.source.levels[0][...] = 0.2
        for at in directions(12):
            light = np.exp(8 * (there @ at - 1))[..., None] * random.uniform(0.5, 2, 3)
            cls.source.levels[0][...] += light.astype(np.float32)

    def test_levels(self) -> None:
        made = kiln.bake(self.source, size=32, level_count=4)
        report = kiln.check(self.source, made.map)
        self.assertEqual(report.faults, [])
        self.assertLess(report.worst, 1e-4)
        self.assertEqual([level.size for level in report.levels], [32, 16, 8, 4])
        self.assertEqual((report.axis, report.sign, report.brightness), ((0, 1, 2), (1, 1, 1), 1))
        self.assertEqual(report.difference.levels[1].shape, (6, 16, 16, 3))
        turned = kiln.check(self.source, kiln.bake(self.source, size=32, level_count=4, mirror=True).map, "gltf")
        self.assertEqual(len(turned.faults), 1)
        self.assertIn("mirrored: left and right are swapped", turned.faults[0])
        self.assertEqual([f.kind for f in turned.findings if f.fault], ["axes"])

    def test_files(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            path = os.path.join(work, "a.glb")
            kiln.bake(self.source, "gltf", 32, tune="none").save(path)
            self.assertEqual(kiln.load_levels(path).levels[0].shape, (6, 32, 32, 3))
            report = kiln.check(self.source, path, "gltf")
            self.assertEqual(report.faults, [])
            self.assertLess(report.worst, 0.01)
            shown = kiln.check_shown(self.source, path, "gltf")
            self.assertEqual(shown.rms.shape, (19,))
            self.assertLess(0, shown.all)
            self.assertLess(shown.all, shown.worst)
            table = os.path.join(work, "dfg.png")
            kiln.table("dfg", width=16, height=16).save(table)
            found = kiln.check_table(table)
            self.assertEqual((found.content, found.faults), (["a", "b", "zero"], []))
            self.assertLess(found.rms, 1e-5)
            with self.assertRaisesRegex(kiln.FileError, "none.ktx2"):
                kiln.check(self.source, os.path.join(work, "none.ktx2"))

    def test_harmonics(self) -> None:
        right = kiln.harmonics(self.source)
        self.assertLess(kiln.check_harmonics(self.source, right).rms, 1e-6)
        wrong = kiln.Harmonics(right.filter(irradiance=True).c)  # irradiance that is called radiance
        report = kiln.check_harmonics(self.source, wrong)
        self.assertEqual(len(report.faults), 1)
        self.assertIn("irradiance", report.faults[0])


if __name__ == "__main__":
    unittest.main()

"""scripts.py ROOT FOLDER: laws of the scripts' functions. FOLDER has a light map in maps/, and the means of its EXR in means.json."""
import glob
import json
import math
import os
import random
import sys

root, folder = sys.argv[1:]
sys.path += [os.path.join(root, "examples/blender"), os.path.join(root, "bench/peers")]
import glb
import maps

for path in [*glob.glob(os.path.join(root, "examples/blender/*.py")), *glob.glob(os.path.join(root, "bench/peers/*.py")),
             os.path.join(root, "bench/peers/measure")]:
    with open(path, encoding="utf-8") as file:
        compile(file.read(), path, "exec")


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), f"{a} is not {b}"


def fails(function, *arguments):
    try:
        function(*arguments)
    except SystemExit:
        return
    raise AssertionError(f"{function.__name__} accepts {arguments}")


# A GLB that is read and written again is the same document; another file is refused.
scene = os.path.join(folder, "maps/scene.glb")
document, rest = glb.read(scene)
[entry] = glb.light_maps(document)
assert entry["uri"] == "irradiance.exr" and entry["scale"] == 1, entry
assert not glb.light_maps(document, "back") and glb.sky(document) == [0, 0, 0]
assert [glb.light_map_set(mesh) for mesh in document["meshes"]] == [1] * 8
copy = os.path.join(folder, "copy.glb")
glb.write(copy, document, rest)
assert glb.read(copy) == (document, rest) and os.path.getsize(copy) % 4 == 0
fails(glb.read, os.path.join(folder, "means.json"))
assert set(glb.material_pages(document).values()) == {0}

# Pages of a map divide materials; a material on two of them is refused.
divided = glb.read(os.path.join(folder, "pages/scene.glb"))[0]
uris = [page["uri"] for page in glb.light_maps(divided)]
assert len(uris) > 1 and uris == [f"irradiance.{i}.exr" for i in range(len(uris))], uris
assert set(glb.material_pages(divided).values()) == set(range(len(uris)))
primitives = [{"material": 0, "extras": {"afterglow_lightmap": {"texCoord": 1, "page": i}}} for i in range(2)]
fails(glb.material_pages, {"meshes": [{"primitives": primitives}]})
fails(glb.light_map_set, {"primitives": [{}, {"extras": {"afterglow_lightmap": {"texCoord": 1}}}]})

# A diffuse copy has no specular lobe and the same emission.
diffuse = os.path.join(folder, "diffuse.glb")
glb.make_diffuse(scene, diffuse)
for before, after in zip(document["materials"], glb.read(diffuse)[0]["materials"]):
    assert after["extensions"].pop("KHR_materials_specular") == {"specularFactor": 0}
    assert after["extensions"] == before.get("extensions", {}), after
    assert after["pbrMetallicRoughness"]["baseColorFactor"] == before["pbrMetallicRoughness"]["baseColorFactor"]

# The EXR reader finds the mean that `afterglow diff` prints.
read = maps.read_exr(os.path.join(folder, "maps/irradiance.exr"))
assert read.size == (entry["width"], entry["height"])
with open(os.path.join(folder, "means.json"), encoding="utf-8") as file:
    mean = sum(weight * value for weight, value in zip(maps.LUMINANCE, json.load(file)["mean_a"]))
near(sum(value or 0 for value in read.luminance) / len(read.luminance), mean, 1e-4)
fails(maps.read_exr, scene)


def grey(width, height, values, covered=None):
    return maps.Map(width, height, [values] * 3, covered)


# Texels at the border of Cycles' charts, and those without light in any map, are not compared.
covered = [x < 4 for y in range(5) for x in range(6)]
theirs = grey(6, 5, [1.0] * 30, covered)
ours = grey(6, 5, [0.0 if i == 14 else 1.0 for i in range(30)])
inner = maps.common_texels([ours], [theirs])
assert inner == [7, 8, 13, 19, 20], inner
fails(maps.common_texels, [grey(5, 6, [1.0] * 30)], [theirs])

# Noise is the relative variance of one map, however many there are, and does not depend on the unit.
rng = random.Random(1)
texels = range(20000)
for count in (2, 4):
    for unit in (1, 1000):
        noisy = [grey(200, 100, [unit * rng.gauss(10, 1) for _ in texels]) for _ in range(count)]
        near(maps.noise(noisy, texels)[0], 0.01, 0.05)
# Of two maps the median of a normal distribution's variance is that of chi-squared with one degree of freedom: 0.4549.
pair = [grey(200, 100, [rng.gauss(10, 1) for _ in texels]) for _ in range(2)]
near(maps.noise(pair, texels)[1], 0.004549, 0.1)
near(maps.noise(pair, texels)[0], sum((a - b) ** 2 for a, b in zip(*(m.luminance for m in pair))) / 2 / len(texels) / 100, 0.01)
brighter = [grey(200, 100, [1.1 * value for value in m.luminance]) for m in pair]
assert all(math.isclose(ratio, 1.1, rel_tol=1e-9) for ratio in maps.difference(brighter, pair, texels))

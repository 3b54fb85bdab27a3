"""In Blender: bakes the light map of a scene.glb by Cycles, into the texels that afterglow chose.

    blender --background --factory-startup --threads N --python cycles_bake.py -- SCENE.glb PATHS OUT SEED...

OUT-SEED.f32 has RGB, in lux, and a last channel that is 0 where Cycles has no texel; top row first. OUT.json has the seconds.
"""
import json
import math
import os
import resource
import sys

import bpy
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../examples/blender"))
import glb
import lightmapped


def make_diffuse(material, image):
    """A Lambertian surface with the emission of the file; its active image is what is baked."""
    surface = lightmapped.Surface(material)
    if not surface.principled:
        raise SystemExit(f"material {material.name}: unlit surfaces are not compared")
    diffuse = surface.node("ShaderNodeBsdfDiffuse", surface.given("Base Color"))["BSDF"]
    emission = surface.node("ShaderNodeEmission", surface.emission(), 1.0)["Emission"]
    surface.finish(surface.node("ShaderNodeAddShader", diffuse, emission)["Shader"], surface.opacity())
    target = surface.tree.nodes.new("ShaderNodeTexImage")
    target.image = image
    surface.tree.nodes.active = target


def join_objects():
    """One object of all that has texels: Cycles bakes objects one after the other, each in a scene built again."""
    objects = [o for o in bpy.data.objects if o.type == "MESH" and lightmapped.UV_MAP in o.data.uv_layers]
    bpy.ops.object.select_all(action="DESELECT")
    for chosen in objects:
        chosen.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.join()


def set_sampling(scene, paths):
    """Unbiased, as afterglow's: no clamping, all bounces, no adaptive sampling, no denoiser."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = paths
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.light_sampling_threshold = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.transparent_max_bounces = 1024
    bake = scene.render.bake
    bake.margin = 0
    bake.use_clear = True


def bake(scene, image, seed):
    """The user and system seconds of the operator: it builds Cycles' scene and its BVH, and traces."""
    scene.cycles.seed = seed
    before = resource.getrusage(resource.RUSAGE_SELF)
    # Diffuse light without the colour of the surface: irradiance / pi.
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, uv_layer=lightmapped.UV_MAP)
    after = resource.getrusage(resource.RUSAGE_SELF)
    pixels = numpy.empty(image.size[0] * image.size[1] * 4, dtype="<f4")
    image.pixels.foreach_get(pixels)
    texels = pixels.reshape(image.size[1], image.size[0], 4)[::-1].copy()
    texels[..., :3] *= math.pi
    return texels, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(path, paths, out, *seeds):
    document = lightmapped.load(path)
    if any(light.type == "SPOT" for light in bpy.data.lights):
        raise SystemExit(f"{path}: Blender's spots have another penumbra than those of glTF")
    size = glb.light_maps(document)[0]
    image = bpy.data.images.new("texels", size["width"], size["height"], alpha=True, float_buffer=True, is_data=True)
    image.generated_color = (0, 0, 0, 0)
    for material in bpy.data.materials:
        make_diffuse(material, image)
    join_objects()
    scene = bpy.context.scene
    set_sampling(scene, 1)
    bake(scene, image, 0)  # what Cycles does once, such as loading kernels, is part of no measurement
    set_sampling(scene, int(paths))
    seconds = []
    for seed in seeds:
        texels, spent = bake(scene, image, int(seed))
        texels.tofile(f"{out}-{seed}.f32")
        seconds.append(spent)
    with open(f"{out}.json", "w") as file:
        json.dump({"version": bpy.app.version_string, "seconds": seconds}, file)


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1:])

"""Opens a light map of afterglow in Blender and renders it as `afterglow render --tonemap linear` shows the same light.

    blender --background --factory-startup --python open_lightmap.py -- maps/scene.glb image.png --exposure EV

README.md has the options and the units.
"""
import argparse
import math
import os
import sys

import bpy
import mathutils

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import glb
import lightmapped


def arguments():
    parser = argparse.ArgumentParser(prog="open_lightmap.py")
    parser.add_argument("scene", help="scene.glb of afterglow bake --lightmap, with the maps beside it")
    parser.add_argument("image", help=".png, or .exr for radiance in cd/m²")
    parser.add_argument("--exposure", type=float, default=0.0, metavar="EV", help="at ISO 100, as of afterglow render")
    parser.add_argument("--size", default="1280x720", metavar="WxH")
    parser.add_argument("--eye", type=point, metavar="X,Y,Z", help="camera, +y up; default: the first one of the scene")
    parser.add_argument("--target", type=point, metavar="X,Y,Z", help="a point in the image centre")
    parser.add_argument("--fov", type=float, default=60.0, metavar="DEG", help="vertical, with --eye")
    parser.add_argument("--samples", type=int, default=16, help="per pixel, for smooth edges: nothing else has noise")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def point(text):
    """Blender has +z up."""
    x, y, z = map(float, text.split(","))
    return mathutils.Vector((x, -z, y))


class Maps:
    """The images of a light map's pages, and the lux of their value 1. The back of double-sided surfaces may have its own."""

    def __init__(self, document, folder):
        self.image, self.scale = {}, {}
        for side in ("front", "back"):
            for page, entry in enumerate(glb.light_maps(document, side)):
                self.image[side, page] = bpy.data.images.load(os.path.join(folder, entry["uri"]))
                self.image[side, page].colorspace_settings.name = "Non-Color"  # numbers, not a display's colours
                self.scale[side, page] = entry["scale"]
        if not self.image:
            raise SystemExit("no light map in EXR format: bake with --lightmap-format exr")
        self.has_back = ("back", 0) in self.image

    def irradiance(self, surface, side):
        at = side, surface.material.get("light_map_page", 0)
        texels = surface.node("ShaderNodeUVMap", uv_map=lightmapped.UV_MAP)["UV"]
        colour = surface.node("ShaderNodeTexImage", texels, image=self.image[at], interpolation="Linear", extension="EXTEND")["Color"]
        return surface.vector("SCALE", colour, self.scale[at])


def show_light(material, maps, white):
    """The material emits towards the camera what it emits and what it reflects of the map: base colour / pi times irradiance. It
    reflects the lights that are left."""
    surface = lightmapped.Surface(material)
    if not surface.principled:
        surface.unlit.inputs["Strength"].default_value = white
        return
    irradiance = maps.irradiance(surface, "front")
    if maps.has_back and not material.use_backface_culling:
        is_back = surface.node("ShaderNodeNewGeometry")["Backfacing"]
        irradiance = surface.mix(is_back, irradiance, maps.irradiance(surface, "back"))
    metallic = surface.given("Metallic")  # metals have no diffuse reflection
    albedo = surface.vector("SCALE", surface.given("Base Color"), surface.math("SUBTRACT", 1.0, metallic))
    reflected = surface.vector("SCALE", surface.vector("MULTIPLY", albedo, irradiance), 1 / math.pi)
    radiance = surface.vector("ADD", reflected, surface.emission())
    to_camera = surface.node("ShaderNodeLightPath")["Is Camera Ray"]  # else it would light other surfaces, which the map did
    emission = surface.node("ShaderNodeEmission", radiance, to_camera)["Emission"]
    diffuse = surface.node("ShaderNodeBsdfDiffuse", albedo, 0.0, *surface.normal())["BSDF"]
    # The camera sees through the back of a single-sided surface; shadows are those of both sides.
    seen = surface.math("MAXIMUM", surface.front(), surface.math("SUBTRACT", 1.0, to_camera))
    surface.finish(surface.node("ShaderNodeAddShader", emission, diffuse)["Shader"], surface.math("MULTIPLY", surface.opacity(), seen))


def choose_lights():
    """Lights of a map that has their indirect light alone shine. The others are in it, or were not in the bake."""
    for light in (o for o in bpy.data.objects if o.type == "LIGHT"):
        part = light.data["afterglow_lightmap"]
        light.hide_render = part["direct"] or not part["indirect"]


def choose_camera(scene, options):
    cameras = [o for o in scene.objects if o.type == "CAMERA"]
    if not options.eye or not options.target:
        if not cameras:
            raise SystemExit("the scene has no camera: give --eye and --target, which `afterglow info` prints")
        scene.camera = cameras[0]
        return
    data = bpy.data.cameras.new("eye")
    data.sensor_fit, data.angle_y = "VERTICAL", math.radians(options.fov)
    data.clip_start, data.clip_end = 0.01, 1e6
    scene.camera = bpy.data.objects.new("eye", data)
    scene.collection.objects.link(scene.camera)
    scene.camera.location = options.eye
    scene.camera.rotation_euler = (options.target - options.eye).to_track_quat("-Z", "Y").to_euler()


def set_output(scene, options, white):
    """Exposure and tone curve of `--exposure EV --tonemap linear`: radiance / (1.2 * 2^EV), cut off at 1, encoded as sRGB."""
    render, image = scene.render, scene.render.image_settings
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = map(int, options.size.split("x"))
    render.resolution_percentage = 100
    render.dither_intensity = 0
    scene.cycles.samples = options.samples
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces, scene.cycles.transparent_max_bounces = 0, 64
    scene.cycles.sample_clamp_direct = 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.exposure = -math.log2(white)
    render.filepath = os.path.abspath(options.image)
    is_exr = options.image.endswith(".exr")
    image.file_format = "OPEN_EXR" if is_exr else "PNG"
    image.color_mode, image.color_depth = "RGB", "32" if is_exr else "8"


def main():
    options = arguments()
    document = lightmapped.load(options.scene)
    maps = Maps(document, os.path.dirname(os.path.abspath(options.scene)))
    white = 1.2 * 2 ** options.exposure  # cd/m² that are exposed to 1
    for material in bpy.data.materials:
        show_light(material, maps, white)
    for mesh in (o for o in bpy.data.objects if o.type == "MESH"):
        mesh.hide_render = lightmapped.UV_MAP not in mesh.data.uv_layers  # objects that move have no texels
    choose_lights()
    scene = bpy.context.scene
    scene.world.cycles_visibility.diffuse = False  # its light is in the map
    choose_camera(scene, options)
    set_output(scene, options, white)
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()

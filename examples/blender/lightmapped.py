"""Loads scene.glb of `afterglow bake --lightmap` into Blender: one light unit, and the coordinates of texels by name."""
import os
import tempfile

import bpy
import numpy

import glb

if "bool" not in vars(numpy):
    numpy.bool = bool  # the importer of Blender 3.4 uses it; NumPy 1.24, with which Debian 12 runs Blender, lacks it

UV_MAP = "light map"


def load(path):
    """Replaces the scene. Radiance 1 of Blender is 1 cd/m². Returns the glTF JSON."""
    document, rest = glb.read(path)
    for mesh in document.get("meshes", []):  # a property of the mesh in Blender, which names may not identify
        mesh.setdefault("extras", {})["light_map_set"] = glb.light_map_set(mesh)
    for material, page in glb.material_pages(document).items():
        if material is not None:
            document["materials"][material].setdefault("extras", {})["light_map_page"] = page
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with tempfile.TemporaryDirectory() as folder:
        marked = os.path.join(folder, "marked.glb")
        glb.write(marked, document, rest)
        # COMPAT: lux and candela are not divided by 683 lm/W. Releases name the option differently.
        options = bpy.ops.import_scene.gltf.get_rna_type().properties.keys()
        unit = next(name for name in options if name.endswith("convert_lighting_mode"))
        bpy.ops.import_scene.gltf(filepath=marked, **{unit: "COMPAT"})
    for mesh in bpy.data.meshes:
        name_coordinates(mesh)
    for light in bpy.data.lights:  # without a size, as in glTF
        if light.type == "SUN":
            light.angle = 0
        else:
            light.shadow_soft_size = 0
    set_sky(glb.sky(document))
    return document


def name_coordinates(mesh):
    """The importer makes a UV map of each set, in their order."""
    texels = mesh.get("light_map_set")
    if texels is not None:
        mesh.uv_layers[texels].name = UV_MAP


def set_sky(radiance):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*radiance, 1)
    background.inputs["Strength"].default_value = 1
    bpy.context.scene.world = world


class Surface:
    """A material of the importer whose shader is replaced: what it says, and new nodes."""

    def __init__(self, material):
        self.material, self.tree = material, material.node_tree
        kinds = {node.bl_idname: node for node in self.tree.nodes}
        self.principled = kinds.get("ShaderNodeBsdfPrincipled")  # None: unlit, an emission that the camera alone sees
        self.unlit = kinds.get("ShaderNodeEmission")
        self.output = kinds["ShaderNodeOutputMaterial"]

    def node(self, kind, *inputs, **properties):
        """A new node; inputs are sockets to link, or values. Returns its outputs by name."""
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        for socket, value in zip((s for s in node.inputs if s.enabled), inputs):
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(socket, value)
            else:
                socket.default_value = value if isinstance(value, (int, float)) else value[:len(socket.default_value)]
        return {socket.name: socket for socket in node.outputs if socket.enabled}

    def math(self, operation, a, b):
        return self.node("ShaderNodeMath", a, b, operation=operation)["Value"]

    def vector(self, operation, a, b):
        """A colour times a colour (MULTIPLY) or a number (SCALE), or plus a colour (ADD)."""
        return self.node("ShaderNodeVectorMath", a, b, operation=operation)["Vector"]

    def mix(self, share, a, b):
        """Colour a, or b where the share is 1."""
        return self.vector("ADD", self.vector("SCALE", a, self.math("SUBTRACT", 1.0, share)), self.vector("SCALE", b, share))

    def given(self, *names):
        """What the importer gave an input, whose name differs among releases: a socket, or a value."""
        socket = next(self.principled.inputs[name] for name in names if name in self.principled.inputs)
        if socket.is_linked:
            return socket.links[0].from_socket
        value = socket.default_value
        return value if isinstance(value, float) else tuple(value)

    def normal(self):
        """The normal map, as the last inputs of a node; none: the vertex normal."""
        links = self.principled.inputs["Normal"].links
        return [link.from_socket for link in links]

    def emission(self):
        """The emitted radiance of the front, in cd/m²; of both sides if the material is double-sided."""
        colour = self.given("Emission Color", "Emission")
        return self.vector("SCALE", colour, self.math("MULTIPLY", self.given("Emission Strength"), self.front()))

    def front(self):
        """1, but 0 on the back of a single-sided material."""
        if not self.material.use_backface_culling:
            return 1.0
        return self.math("SUBTRACT", 1.0, self.node("ShaderNodeNewGeometry")["Backfacing"])

    def opacity(self):
        """0 or 1: afterglow draws blended materials as masks, and Cycles knows no mask."""
        if self.material.blend_method == "OPAQUE":
            return 1.0
        cutoff = self.material.alpha_threshold if self.material.blend_method == "CLIP" else 0.5
        return self.math("GREATER_THAN", self.given("Alpha"), cutoff)

    def finish(self, shader, opacity):
        """The shader of the surface, and a hole in it where the opacity is 0."""
        hole = self.node("ShaderNodeBsdfTransparent")["BSDF"]
        shader = self.node("ShaderNodeMixShader", opacity, hole, shader)["Shader"]
        self.tree.links.new(self.output.inputs["Surface"], shader)

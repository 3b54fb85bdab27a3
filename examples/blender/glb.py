"""Reads and writes the JSON of binary glTF files, and finds their light maps (docs/lightmaps.md). Needs no Blender."""
import json
import struct

MAGIC, JSON, HEADER = b"glTF", b"JSON", 20


def read(path):
    """The JSON of a GLB, and all bytes after it."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version, _, length, kind = struct.unpack_from("<4sIII4s", data.ljust(HEADER, b"\0"))
    if (magic, version, kind) != (MAGIC, 2, JSON):
        raise SystemExit(f"{path}: not a binary glTF 2.0 file")
    return json.loads(data[HEADER:HEADER + length]), data[HEADER + length:]


def write(path, document, rest):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIII4s", MAGIC, 2, HEADER + len(text) + len(rest), len(text), JSON))
        file.write(text + rest)


def light_maps(document, side="front", file_format="exr"):
    """The entries of a map in the file's extras, page by page: uri, width, height, and scale, the lux of the value 1."""
    maps = document.get("extras", {}).get("afterglow_lightmap", {}).get("maps", [])
    return [m for m in maps if m["side"] == side and m["format"] == file_format]


def material_pages(document):
    """The page of each material that has texels, by its index."""
    pages = {}
    for primitive in (p for mesh in document["meshes"] for p in mesh["primitives"]):
        texels, material = primitive.get("extras", {}).get("afterglow_lightmap"), primitive.get("material")
        if texels and pages.setdefault(material, texels.get("page", 0)) != texels.get("page", 0):
            raise SystemExit(f"material {material} is on several pages of the map: another program has joined its copies")
    return pages


def light_map_set(mesh):
    """The set of a mesh that has the coordinates of its texels: 1 is TEXCOORD_1. None: it has no texels."""
    sets = {p.get("extras", {}).get("afterglow_lightmap", {}).get("texCoord") for p in mesh["primitives"]}
    if len(sets) > 1:
        raise SystemExit(f"mesh {mesh.get('name', '')}: its primitives have their texels in different sets, {sets}")
    return sets.pop()


def sky(document):
    """Radiance of the sky in cd/m², which glTF has no member for."""
    scene = document.get("scenes", [{}])[document.get("scene", 0)]
    return scene.get("extras", {}).get("afterglow_sky", [0.0, 0.0, 0.0])


def make_diffuse(source, target):
    """A copy with Lambertian materials, which two extensions of glTF say exactly, and without normal maps."""
    document, rest = read(source)
    for material in document.setdefault("materials", []):
        material.pop("normalTexture", None)
        kept = {name: value for name, value in material.get("extensions", {}).items()
                if name in ("KHR_materials_emissive_strength", "KHR_materials_unlit")}
        material["extensions"] = {**kept, "KHR_materials_specular": {"specularFactor": 0.0}}
        shading = material.setdefault("pbrMetallicRoughness", {})
        shading.pop("metallicRoughnessTexture", None)
        shading["metallicFactor"] = 0.0
    used = set(document.get("extensionsUsed", [])) | {"KHR_materials_specular"}
    document["extensionsUsed"] = sorted(used)
    write(target, document, rest)

class_name AfterglowLightmap
extends RefCounted
## Opens scene.glb of `afterglow bake --lightmap` with its map: Godot 4.4 or newer, in the game or in the editor.
## README.md has what it does, and what was tried.

## Displayed value of 1 cd/m²: 1 / (1.2 * 2^EV).
var exposure := 1.0

var _state := GLTFState.new()


## The scene, or null. Add it to the tree, then call light().
func open(folder: String, ev: float) -> Node3D:
	exposure = 1.0 / (1.2 * pow(2.0, ev))
	var document := GLTFDocument.new()
	var glb := FileAccess.get_file_as_bytes(folder.path_join("scene.glb"))
	if document.append_from_buffer(glb, "", _state) != OK:
		return null
	if _state.json.extras.afterglow_lightmap.maps.any(func(m): return m.has("page")):
		push_error("afterglow: the light map has several pages, bake it without --page")
		return null
	var scene := document.generate_scene(_state) as Node3D
	scene.set_meta("folder", folder)
	return scene


## Gives the scene its map, its lights and its emission, all at the exposure.
func light(scene: Node3D) -> void:
	var gi := LightmapGI.new()
	scene.add_child(gi)
	var data := LightmapGIData.new()
	data.lightmap_textures = [_texels(scene.get_meta("folder"))]
	for mesh: MeshInstance3D in scene.find_children("*", "MeshInstance3D", true, false):
		if mesh.mesh.surface_get_format(0) & Mesh.ARRAY_FORMAT_TEX_UV2:
			data.add_user(gi.get_path_to(mesh), Rect2(0, 0, 1, 1), 0, -1)
		_expose_emission(mesh.mesh)
	gi.light_data = data
	for i in _state.nodes.size():
		var index: int = _state.nodes[i].light
		if index >= 0:
			_expose_light(_state.get_scene_node(i), _state.json.extensions.KHR_lights_punctual.lights[index])


## Radiance of the sky, cd/m².
func sky() -> Color:
	var scene: Dictionary = _state.json.scenes[_state.json.get("scene", 0)]
	var radiance: Array = scene.get("extras", {}).get("afterglow_sky", [0, 0, 0])
	return Color(radiance[0], radiance[1], radiance[2])


# Godot multiplies texels by the albedo alone: they are E / pi.
func _texels(folder: String) -> Texture2DArray:
	var maps: Array = _state.json.extras.afterglow_lightmap.maps
	var map: Dictionary = maps.filter(func(m): return m.format == "ktx2" and m.side == "front")[0]
	var image := Image.new()
	image.load_ktx_from_buffer(FileAccess.get_file_as_bytes(folder.path_join(map.uri)))
	var light := Image.create_empty(image.get_width(), image.get_height(), false, Image.FORMAT_RGBAH)
	var factor: float = map.scale * exposure / PI
	for y in image.get_height():
		for x in image.get_width():
			light.set_pixel(x, y, image.get_pixel(x, y) * factor)
	var texels := Texture2DArray.new()
	texels.create_from_images([light])
	return texels


func _expose_emission(mesh: Mesh) -> void:
	for i in mesh.get_surface_count():
		var material := mesh.surface_get_material(i) as BaseMaterial3D
		if material and material.emission_enabled and not material.has_meta("exposed"):
			material.emission_energy_multiplier *= exposure
			material.set_meta("exposed", true)


# The energy 1 of a light gives a white surface the radiance 1, not 1 / pi.
func _expose_light(node: Light3D, light: Dictionary) -> void:
	var part: Dictionary = light.extras.afterglow_lightmap
	node.light_energy = light.get("intensity", 1.0) * exposure / PI
	node.shadow_enabled = true
	node.light_bake_mode = Light3D.BAKE_DYNAMIC
	if part.direct:
		node.light_bake_mode = Light3D.BAKE_STATIC # lights objects without texels alone
	node.visible = part.indirect

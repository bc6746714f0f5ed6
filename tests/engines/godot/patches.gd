# Draws white diffuse patches of 64 normals in Godot 3, lit by the first light of lights.json by the lines of
# docs/engines/godot.md. Out: for each patch a line "patch", the normal, and the linear red, green and blue.
extends SceneTree

const COUNT = 64
const CELL = 4
const FRAMES = 4 # after which everything is drawn

var viewport = Viewport.new()
var normals = []
var frames = 0

func to_srgb(c):
	return 12.92 * c if c <= 0.0031308 else 1.055 * pow(c, 1 / 2.4) - 0.055

func make_mesh():
	var tool_ = SurfaceTool.new()
	tool_.begin(Mesh.PRIMITIVE_TRIANGLES)
	for i in range(COUNT):
		var z = 1 - 2 * (i + 0.5) / COUNT
		var side = sqrt(1 - z * z)
		var normal = Vector3(side * cos(i * 2.399963), side * sin(i * 2.399963), z)
		normals.append(normal)
		for corner in [[0, 0], [1, 1], [1, 0], [0, 0], [0, 1], [1, 1]]:
			tool_.add_normal(normal)
			tool_.add_vertex(Vector3(i + corner[0] - COUNT / 2, corner[1] - 0.5, 0))
	var material = SpatialMaterial.new()
	material.params_diffuse_mode = SpatialMaterial.DIFFUSE_LAMBERT
	material.params_specular_mode = SpatialMaterial.SPECULAR_DISABLED
	material.roughness = 1
	var mesh = MeshInstance.new()
	mesh.mesh = tool_.commit(null, 0) # 0: floats instead of bytes for normals
	mesh.material_override = material
	return mesh

func make_sun():
	var file = File.new()
	file.open("res://lights.json", File.READ)
	var light = JSON.parse(file.get_as_text()).result.lights[0]
	var x = light.direction[0]
	var y = light.direction[1]
	var z = light.direction[2]
	var brightest = light.irradiance.max()
	var sun = DirectionalLight.new()
	sun.transform = Transform().looking_at(Vector3(x, -y, z), Vector3.UP)
	sun.light_energy = brightest / PI
	sun.light_color = Color(to_srgb(light.irradiance[0] / brightest), to_srgb(light.irradiance[1] / brightest),
			to_srgb(light.irradiance[2] / brightest))
	return sun

func make_camera():
	var camera = Camera.new()
	camera.set_orthogonal(COUNT, 1, 100)
	camera.keep_aspect = Camera.KEEP_WIDTH
	camera.translation = Vector3(0, 0, 50)
	return camera

func _init():
	viewport.size = Vector2(COUNT * CELL, CELL)
	viewport.world = World.new()
	viewport.own_world = true
	viewport.world.environment = Environment.new()
	viewport.world.environment.background_mode = Environment.BG_COLOR
	viewport.world.environment.ambient_light_energy = 0
	viewport.hdr = true
	viewport.keep_3d_linear = true
	viewport.usage = Viewport.USAGE_3D
	viewport.render_target_update_mode = Viewport.UPDATE_ALWAYS
	var camera = make_camera()
	for node in [make_mesh(), make_sun(), camera]:
		viewport.add_child(node)
	get_root().add_child(viewport)
	camera.current = true

func _idle(_seconds):
	frames += 1
	if frames != FRAMES:
		return
	var image = viewport.get_texture().get_data()
	image.lock()
	for i in range(COUNT):
		var color = image.get_pixel(CELL * i + CELL / 2, CELL / 2)
		print("patch ", normals[i].x, " ", normals[i].y, " ", normals[i].z, " ", color.r, " ", color.g, " ", color.b)
	quit()

# Draws the panorama sky.exr in Godot 3 as a sky, by the lines of docs/engines/godot.md, and its reflection by metal.
# Out: lines "sky" and "metal" with a direction, in which the camera looks or which the metal reflects, and the linear
# red, green and blue that are seen there.
extends SceneTree

const SIZE = 4
const FRAMES = 10 # after which the engine has filtered the sky

var viewports = []
var frames = 0

func make_sky():
	var image = Image.new()
	image.load("res://sky.exr")
	var texture = ImageTexture.new()
	texture.create_from_image(image, Texture.FLAG_FILTER)
	var sky = PanoramaSky.new()
	sky.panorama = texture
	sky.radiance_size = Sky.RADIANCE_SIZE_64
	return sky

func make_environment(sky):
	var environment = Environment.new()
	environment.background_mode = Environment.BG_SKY
	environment.background_sky = sky
	environment.ambient_light_sky_contribution = 1
	return environment

func make_metal():
	var material = SpatialMaterial.new()
	material.metallic = 1
	material.roughness = 0.1
	var mesh = MeshInstance.new()
	mesh.mesh = QuadMesh.new()
	mesh.mesh.size = Vector2(100, 100)
	mesh.material_override = material
	return mesh

# A view that looks along `way`, at the sky or at metal behind which the camera sees the sky that is at its back.
func add_view(environment, way, metal):
	var viewport = Viewport.new()
	viewport.size = Vector2(SIZE, SIZE)
	viewport.world = World.new()
	viewport.own_world = true
	viewport.world.environment = environment
	viewport.hdr = true
	viewport.keep_3d_linear = true
	viewport.usage = Viewport.USAGE_3D
	viewport.render_target_update_mode = Viewport.UPDATE_ALWAYS
	var camera = Camera.new()
	camera.fov = 10
	var up = Vector3.UP if abs(way.y) < 0.9 else Vector3.BACK
	camera.transform = Transform().looking_at(way, up)
	viewport.add_child(camera)
	if metal:
		var mesh = make_metal()
		mesh.transform = Transform(camera.transform.basis, 5 * way)
		viewport.add_child(mesh)
	get_root().add_child(viewport)
	camera.current = true
	viewports.append([viewport, way, metal])

func _init():
	var environment = make_environment(make_sky())
	for i in range(8):
		var z = 1 - 2 * (i + 0.5) / 8
		var side = sqrt(1 - z * z)
		for metal in [false, true]:
			add_view(environment, Vector3(side * cos(i * 2.399963), side * sin(i * 2.399963), z), metal)

func _idle(_seconds):
	frames += 1
	if frames != FRAMES:
		return
	for row in viewports:
		var image = row[0].get_texture().get_data()
		image.lock()
		var way = -row[1] if row[2] else row[1]
		var color = image.get_pixel(SIZE / 2, SIZE / 2)
		print("metal " if row[2] else "sky ", way.x, " ", way.y, " ", way.z, " ", color.r, " ", color.g, " ", color.b)
	quit()

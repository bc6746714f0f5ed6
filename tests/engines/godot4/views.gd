# Draws with Godot 4 what tests/engines/godot4.mjs looks at, by the lines of docs/engines/godot.md: the panorama sky.exr
# as a sky, whose radiance is encoded in sRGB or not, the encoded sky's reflection by metal, and white diffuse patches lit
# by the first light of lights.json. Pixels are sRGB of 8 bits, so radiance is multiplied such that no pixel is brighter
# than white. Out: a line for each pixel of what it is, a vector, and the linear red, green and blue; at last the line
# "end". The vector is the direction in which the camera looks, the direction which the metal reflects, or the patch's
# normal.
extends Node3D

const SIZE = 4
const SKY_SHARE = 0.3 # of the sky's radiance of 1 to 3
const PATCHES = 64
const FRAMES = 20 # after which the engine has filtered the sky

var views = []
var frames = 0

func make_plain():
	var sky := PanoramaSkyMaterial.new()
	sky.panorama = load("res://sky.exr")
	sky.energy_multiplier = SKY_SHARE
	return sky

func make_encoded():
	var shader := Shader.new()
	shader.code = FileAccess.get_file_as_string("res://shader.txt")
	var sky := ShaderMaterial.new()
	sky.shader = shader
	sky.set_shader_parameter("panorama", load("res://sky.exr"))
	return sky

func make_environment(sky):
	var environment := Environment.new()
	environment.background_mode = Environment.BG_SKY
	environment.sky = Sky.new()
	environment.sky.sky_material = sky
	return environment

func make_black():
	var environment := Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
	environment.reflected_light_source = Environment.REFLECTION_SOURCE_DISABLED
	return environment

func add_view(what, vector, environment, camera, nodes):
	var viewport := SubViewport.new()
	viewport.size = Vector2i(SIZE, SIZE)
	viewport.own_world_3d = true
	viewport.world_3d = World3D.new()
	viewport.world_3d.environment = environment
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	for node in [camera] + nodes:
		viewport.add_child(node)
	add_child(viewport)
	camera.current = true
	views.append([viewport, what, vector])

func make_quad(material):
	var quad := MeshInstance3D.new()
	quad.mesh = QuadMesh.new()
	quad.mesh.size = Vector2(100, 100)
	quad.material_override = material
	return quad

func make_basis(way):
	return Basis.looking_at(way, Vector3.UP if abs(way.y) < 0.9 else Vector3.BACK)

func make_camera(way):
	var camera := Camera3D.new()
	camera.fov = 10
	camera.basis = make_basis(way)
	return camera

# A view of each sky, and one of metal that faces the camera and reflects the encoded sky at its back.
func add_sky(way, plain, environment):
	add_view("plain", way, plain, make_camera(way), [])
	add_view("sky", way, environment, make_camera(way), [])
	var metal := StandardMaterial3D.new()
	metal.metallic = 1
	metal.roughness = 0.1
	var quad = make_quad(metal)
	quad.transform = Transform3D(make_basis(way), 5 * way)
	add_view("metal", -way, environment, make_camera(way), [quad])

func make_sun():
	var light = JSON.parse_string(FileAccess.get_file_as_string("res://lights.json")).lights[0]
	var x = light.direction[0]
	var y = light.direction[1]
	var z = light.direction[2]
	var r = light.irradiance[0]
	var g = light.irradiance[1]
	var b = light.irradiance[2]
	var sun := DirectionalLight3D.new()
	var brightest := maxf(r, maxf(g, b))
	sun.basis = Basis.looking_at(Vector3(x, -y, z))
	sun.light_energy = brightest / PI
	sun.light_color = Color(r / brightest, g / brightest, b / brightest).linear_to_srgb()
	sun.light_energy /= brightest / PI # a radiance of at most 1
	return sun

func add_patch(normal):
	var white := StandardMaterial3D.new()
	white.diffuse_mode = BaseMaterial3D.DIFFUSE_LAMBERT
	white.specular_mode = BaseMaterial3D.SPECULAR_DISABLED
	white.roughness = 1
	var quad = make_quad(white)
	quad.transform = Transform3D(make_basis(-normal), -5 * normal)
	add_view("patch", normal, make_black(), make_camera(-normal), [quad, make_sun()])

func point(i, count):
	var z = 1 - 2 * (i + 0.5) / count
	var side = sqrt(1 - z * z)
	return Vector3(side * cos(i * 2.399963), side * sin(i * 2.399963), z)

func _ready():
	var plain = make_environment(make_plain())
	var environment = make_environment(make_encoded())
	for i in range(8):
		add_sky(point(i, 8), plain, environment)
	for i in range(PATCHES):
		add_patch(point(i, PATCHES))

func _process(_seconds):
	frames += 1
	if frames != FRAMES:
		return
	for view in views:
		var color = view[0].get_texture().get_image().get_pixel(SIZE / 2, SIZE / 2).srgb_to_linear()
		print(view[1], " ", view[2].x, " ", view[2].y, " ", view[2].z, " ", color.r, " ", color.g, " ", color.b)
	print("end")

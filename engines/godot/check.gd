# Prints what Godot makes of a GLB and its manifest, as JSON. For the tests:
#
#     godot3-server --path PROJECT --script check.gd
extends SceneTree


func _init():
	var directory = Directory.new()
	directory.open("res://")
	directory.list_dir_begin(true)
	var found = {}
	var name = directory.get_next()
	while name != "":
		if name.ends_with(".glb"):
			found[name] = _told(load("res://" + name).instance())
		name = directory.get_next()
	print("FOUND ", JSON.print(found))
	quit()


func _told(scene):
	var player = scene.find_node("AnimationPlayer", true, false)
	var skeleton = scene.find_node("Skeleton", true, false)
	var known = load("res://clips.gd").new().apply(player, "res://manifest.json")
	var clips = {}
	for each in known:
		var animation = player.get_animation(each)
		clips[each] = {"length": animation.length, "loop": animation.loop}
	var bones = []
	for bone in range(skeleton.get_bone_count()):
		bones.append(skeleton.get_bone_name(bone))
	scene.free()
	return {"clips": clips, "bones": bones}

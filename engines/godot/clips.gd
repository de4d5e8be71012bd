# What Godot cannot know of clips: which of them loop, and how long a round is.
#
# For Godot 3. Call it on the AnimationPlayer of an imported GLB:
#
#     var clips = preload("res://clips.gd").new()
#     clips.apply($exercises/AnimationPlayer, "res://manifest.json")
#
# A round ends one frame after the last key, where the first pose comes again.
# `planted` and `root` are for what the game does with them.
extends Reference


# The clips of a manifest.json, by name.
func read(path):
	var file = File.new()
	if file.open(path, File.READ) != OK:
		push_error("%s cannot be read" % path)
		return {}
	var clips = {}
	for clip in JSON.parse(file.get_as_text()).result["clips"]:
		clips[clip["name"]] = clip
	return clips


# Make the animations of a player loop where the manifest says so; the names that it knows.
func apply(player, path):
	var clips = read(path)
	var known = []
	for name in player.get_animation_list():
		if not clips.has(name):
			continue
		var animation = player.get_animation(name)
		animation.loop = clips[name]["loop"]
		if animation.loop:
			animation.length = clips[name]["round_s"]
		known.append(name)
	return known
